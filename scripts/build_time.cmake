# What shortens the build and changes no result: precompiled headers, and less optimisation where
# it gains no speed. Included after all targets are made.

# Commands read arguments, write reports and compare: the work is done in algorithm/, in units and in
# the memory. Units that do not blend gain nothing by -O3 over -O2. Tests hand work over and look at
# results, but for those that compute by themselves what they compare with. What is light is not
# optimised: tests, and most under sanitizers.
set(commands)
set(units)
if(SYSTEMC_FOUND)
  sgs_targets_below(commands "STATIC|EXECUTABLE" modules/config testbench/builtin
    testbench/command_line testbench/cost testbench/process testbench/result testbench/stability
    testbench/streaminggs testbench/timeline testbench/waveform)
  sgs_targets_below(units STATIC tlm modules)
  list(REMOVE_ITEM units sgs_config sgs_gscore sgs_rendering)
  sgs_targets_below(benches EXECUTABLE testbench/dram testbench/units)
  list(APPEND commands ${benches})
endif()
set(tests)
set(computing)
if(BUILD_TESTING)
  sgs_targets_below(tests EXECUTABLE tests)
  list(APPEND tests sgs_test_main sgs_test_photographs sgs_test_support sgs_test_trace)
  if(SYSTEMC_FOUND)
    list(APPEND tests sgs_exact_frames sgs_system_checks sgs_toy_machine)
  endif()
  set(computing ${tests})
  list(FILTER computing INCLUDE REGEX "^(builtin|clocked|datapath|datapath_rtl|dram|fixed_point_sums\
|gscore_clocked|gscore_parts|order|ordering_rtl|render|rendering_rtl|splat|stability|stiff_tuning|storage\
|streaminggs_parts|tlm|train|tune|vq|voxel)_test$")
  list(REMOVE_ITEM tests ${computing})
endif()
set(unoptimised ${tests})
if(CMAKE_BUILD_TYPE STREQUAL Sanitize)
  # It takes longer to compile than to run, but for what computes pixels, files and commands.
  sgs_targets_below(unoptimised "STATIC|OBJECT|EXECUTABLE" .)
  list(REMOVE_ITEM unoptimised dram_test sgs_builtin sgs_datapath sgs_dram sgs_render sgs_rendering
    sgs_scene_files sgs_splat sgs_voxel)
endif()
foreach(target ${commands} ${computing})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endforeach()
foreach(target ${units})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
endforeach()
foreach(target ${unoptimised})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release,Sanitize>:-O0>)
endforeach()

# sgs_precompile(NAME HEADERS... LIBS... FOLDERS...): everything in FOLDERS that does not yet begin
# with other precompiled headers begins with HEADERS; gcc takes other ones without optimisation.
# These are headers of libraries only, never our own, so that what a folder may not know stays
# unknown to it.
function(sgs_precompile name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBS;DEFINITIONS;FOLDERS" ${ARGN})
  sgs_targets_below(targets "STATIC|OBJECT|EXECUTABLE" ${ARG_FOLDERS})
  foreach(target ${targets})
    get_target_property(other ${target} PRECOMPILE_HEADERS_REUSE_FROM)
    if(other)
      continue()
    endif()
    set(headers ${name})
    if(target IN_LIST unoptimised)
      set(headers ${name}_unoptimised)
      # Without optimisation, inline functions that nobody calls ask for their libraries, too.
      target_link_libraries(${target} PRIVATE ${ARG_LIBS})
    endif()
    if(NOT TARGET ${headers})
      set(empty ${PROJECT_BINARY_DIR}/${headers}.cpp)
      file(TOUCH ${empty})
      add_library(${headers} OBJECT EXCLUDE_FROM_ALL ${empty})
      target_link_libraries(${headers} PRIVATE sgs_options ${ARG_LIBS})
      target_compile_definitions(${headers} PRIVATE ${ARG_DEFINITIONS})
      target_precompile_headers(${headers} PRIVATE ${ARG_HEADERS})
      if(target IN_LIST unoptimised)
        target_compile_options(${headers} PRIVATE $<$<CONFIG:Release,Sanitize>:-O0>)
      endif()
    endif()
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endforeach()
endfunction()

# Not JSON: each file behind nlohmann's header instantiates its parser, whether it reads JSON or not.
set(base_headers <algorithm> <array> <charconv> <cmath> <cstdint> <cstring> <filesystem> <fstream>
  <functional> <limits> <map> <memory> <numeric> <optional> <random> <set> <string> <vector>
  <fmt/format.h> <glm/common.hpp> <glm/geometric.hpp> <glm/mat3x3.hpp> <glm/matrix.hpp>
  <glm/vec3.hpp> <tbb/blocked_range.h> <tbb/parallel_for.h>)
set(systemc_headers <systemc> <tlm> <tlm_utils/multi_passthrough_target_socket.h>
  <tlm_utils/passthrough_target_socket.h> <tlm_utils/peq_with_cb_and_phase.h>
  <tlm_utils/simple_initiator_socket.h>)
set(base_libs fmt::fmt glm::glm TBB::tbb)
set(systemc_libs ${base_libs} sgs_systemc)

# ccache takes no object that begins with a precompiled header, and is worth more.
if(NOT CMAKE_CXX_COMPILER_LAUNCHER MATCHES ccache)
  set(base_folders algorithm testbench/bench testbench/builtin testbench/command_line)
  if(SYSTEMC_FOUND)
    list(APPEND base_folders modules/config)
  endif()
  sgs_precompile(sgs_base_headers HEADERS ${base_headers} LIBS ${base_libs}
    FOLDERS ${base_folders})
  if(SYSTEMC_FOUND)
    sgs_precompile(sgs_systemc_headers HEADERS ${base_headers} ${systemc_headers}
      LIBS ${systemc_libs}
      FOLDERS tlm modules testbench/cost testbench/dram testbench/result testbench/streaminggs
        testbench/timeline testbench/units testbench/waveform)
  endif()
  if(BUILD_TESTING)
    set(test_folders tests/algorithm tests/fuzz tests/testbench)
    if(SYSTEMC_FOUND)
      list(APPEND test_folders tests/modules/config tests/system)
    endif()
    sgs_precompile(sgs_test_headers HEADERS ${base_headers} <catch2/catch.hpp>
      LIBS ${base_libs} Catch2::Catch2 DEFINITIONS CATCH_CONFIG_FAST_COMPILE FOLDERS ${test_folders})
    if(SYSTEMC_FOUND)
      # What is compiled behind SystemC's headers must be linked with it.
      sgs_precompile(sgs_systemc_test_headers
        HEADERS ${base_headers} ${systemc_headers} <catch2/catch.hpp>
        LIBS ${systemc_libs} Catch2::Catch2 DEFINITIONS CATCH_CONFIG_FAST_COMPILE
        FOLDERS tests/modules tests/tlm)
    endif()
  endif()
endif()

# UndefinedBehaviorSanitizer doubles what a file takes to compile. The product's libraries and
# programs have it, for frames, tunings and files that tests hand to them; what only tests is left
# with AddressSanitizer, and so is what it has inlined of the product's headers. Catch has neither.
set(testing)
if(SYSTEMC_FOUND)
  sgs_targets_below(testing "STATIC|OBJECT|EXECUTABLE" testbench/stability testbench/units)
endif()
if(BUILD_TESTING)
  sgs_targets_below(tests "STATIC|OBJECT|EXECUTABLE" tests)
  list(APPEND testing ${tests})
  target_compile_options(sgs_test_main PRIVATE $<$<CONFIG:Sanitize>:-fno-sanitize=all>)
endif()
foreach(target ${testing})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Sanitize>:-fno-sanitize=undefined>)
endforeach()
