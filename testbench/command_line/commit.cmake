# Writes HEADER, which says what commit the program's SOURCES are of, and touches it only when that
# has changed. Commits of tables and texts alone leave a program the same, and its label with it.
cmake_minimum_required(VERSION 3.25)
set(paths algorithm tlm modules testbench CMakeLists.txt :^*.md)
execute_process(COMMAND git -C ${SOURCES} log -1 --format=%h -- ${paths}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND git -C ${SOURCES} status --porcelain --untracked-files=no -- ${paths}
  OUTPUT_VARIABLE changed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(changed)
  string(APPEND commit -dirty)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define SGS_COMMIT \"@commit@\"\n" @ONLY)
