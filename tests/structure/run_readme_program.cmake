# cmake -DPROGRAM=FILE -DEXPECTED=REGEX -P run_readme_program.cmake: runs a program, which has to exit with 0 and to print
# what EXPECTED matches.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND ${PROGRAM} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
message("${out}${err}")
if(NOT code EQUAL 0)
  message(FATAL_ERROR "it exits with ${code}")
endif()
if(EXPECTED AND NOT out MATCHES "${EXPECTED}")
  message(FATAL_ERROR "its output does not match '${EXPECTED}'")
endif()
