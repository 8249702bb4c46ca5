# The libraries of algorithm/, tlm/ and modules/ for other projects, as targets streaminggs::NAME:
# `add_subdirectory` has them, and `find_package(streaminggs)` of a prefix (testbench/embed). The
# target `libraries` builds them. One that was not built is left out of the prefix, and
# find_package() names it.
include(CMakePackageConfigHelpers)
set(folders algorithm)
if(SYSTEMC_FOUND)
  list(APPEND folders tlm modules)
endif()
sgs_targets_below(libraries STATIC ${folders})
set(interfaces sgs_options)
if(SYSTEMC_FOUND)
  list(APPEND interfaces sgs_systemc)
endif()
foreach(target ${interfaces} ${libraries})
  string(REPLACE sgs_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  add_library(streaminggs::${name} ALIAS ${target})
endforeach()
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

add_custom_target(libraries DEPENDS ${libraries})
set(package ${CMAKE_INSTALL_LIBDIR}/streaminggs)
install(TARGETS ${interfaces} ${libraries} EXPORT streaminggs-targets
  ARCHIVE DESTINATION ${package} OPTIONAL
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/streaminggs)
install(DIRECTORY ${folders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/streaminggs
  FILES_MATCHING PATTERN *.h)
install(EXPORT streaminggs-targets NAMESPACE streaminggs:: DESTINATION ${package})
configure_file(scripts/streaminggs-config.cmake.in streaminggs-config.cmake @ONLY)
write_basic_package_version_file(streaminggs-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/streaminggs-config.cmake
  ${PROJECT_BINARY_DIR}/streaminggs-config-version.cmake DESTINATION ${package})
