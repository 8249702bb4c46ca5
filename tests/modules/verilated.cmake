# Modules in Verilog as libraries of C++. Verilator lints them; a warning fails.
find_program(VERILATOR verilator)
if(NOT VERILATOR)
  return()
endif()
execute_process(COMMAND ${VERILATOR} --getenv VERILATOR_ROOT OUTPUT_VARIABLE verilator_root
  OUTPUT_STRIP_TRAILING_WHITESPACE)
find_package(Threads REQUIRED)

# What Verilator's models run on, its own source, where the program is.
add_library(sgs_verilated STATIC ${verilator_root}/include/verilated.cpp
  ${verilator_root}/include/verilated_threads.cpp)
target_compile_options(sgs_verilated PRIVATE -w -O1)
target_include_directories(sgs_verilated SYSTEM PUBLIC ${verilator_root}/include
  ${verilator_root}/include/vltstd)
set_target_properties(sgs_verilated PROPERTIES UNITY_BUILD OFF DISABLE_PRECOMPILE_HEADERS ON)
target_link_libraries(sgs_verilated PUBLIC Threads::Threads)

# sgs_verilate(MODULE FOLDERS... [BLOCKS blocks...]): the library sgs_verilated_MODULE with VMODULE.h, of
# a module in one of these folders and of those that it is made of; the first folder that has one counts.
# BLOCKS: of these, those that are compiled by themselves, once for all of their places, with VBLOCK.h
# (their own text says so, and they keep their parameters). All that enters a block seems to reach what
# leaves it at once, so that circles seem to close.
function(sgs_verilate module)
  cmake_parse_arguments(ARG "" "" "BLOCKS" ${ARGN})
  set(made ${CMAKE_CURRENT_BINARY_DIR}/${module})
  set(sources)
  set(options)
  foreach(folder ${ARG_UNPARSED_ARGUMENTS})
    file(GLOB of_folder CONFIGURE_DEPENDS ${folder}/*.v)
    list(APPEND sources ${of_folder})
    list(APPEND options -y ${folder})
    if(EXISTS ${folder}/${module}.v)
      set(top ${folder}/${module}.v)
    endif()
  endforeach()
  set(archives ${made}/V${module}__ALL.a)
  set(headers ${made}/V${module}.h)
  set(includes ${made})
  foreach(block ${ARG_BLOCKS})
    list(APPEND archives ${made}/V${block}/lib${block}.a)
    list(APPEND headers ${made}/V${block}/V${block}.h)
    list(APPEND includes ${made}/V${block})
  endforeach()
  if(ARG_BLOCKS)
    list(APPEND options --hierarchical -Wno-UNOPTFLAT)
  endif()
  # What runs once, at the beginning, is not optimised.
  add_custom_command(OUTPUT ${archives}
    BYPRODUCTS ${headers}
    COMMAND ${VERILATOR} --cc --build -Wall -O3 -MAKEFLAGS "OPT_FAST=-O1 OPT_SLOW=-O0" -CFLAGS -fPIC
      ${options} --Mdir ${made} ${top} > ${made}.log
    DEPENDS ${sources} VERBATIM)
  add_custom_target(sgs_verilating_${module} DEPENDS ${archives})
  add_library(sgs_verilated_${module} INTERFACE)
  add_dependencies(sgs_verilated_${module} sgs_verilating_${module})
  target_link_libraries(sgs_verilated_${module} INTERFACE ${archives} sgs_verilated)
  target_include_directories(sgs_verilated_${module} SYSTEM INTERFACE ${includes})
endfunction()
