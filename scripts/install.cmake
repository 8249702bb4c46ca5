# What `cmake --install` puts into a prefix: the programs that were built and the data files that
# they read. The build tree has the shape of the prefix, with links to the sources for the data, so
# that a program finds its data in one way (algorithm/files/data_files.h). Included before any folder.
include(GNUInstallDirs)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_BINDIR})
set(SGS_DATADIR ${CMAKE_INSTALL_DATADIR}/streaminggs)
file(RELATIVE_PATH SGS_DATA_FROM_BIN
  ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/streaminggs)

# sgs_data_files(NAME PATH): a folder of JSON files, or one such file, of this source folder.
function(sgs_data_files name path)
  get_filename_component(source ${path} ABSOLUTE)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${SGS_DATADIR})
  file(CREATE_LINK ${source} ${PROJECT_BINARY_DIR}/${SGS_DATADIR}/${name} SYMBOLIC)
  if(IS_DIRECTORY ${source})
    install(DIRECTORY ${source}/ DESTINATION ${SGS_DATADIR}/${name} FILES_MATCHING PATTERN *.json)
  else()
    install(FILES ${source} DESTINATION ${SGS_DATADIR} RENAME ${name})
  endif()
endfunction()

# sgs_program(NAME): a program for users. One that was not built is left out of the prefix.
function(sgs_program name)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)
endfunction()
