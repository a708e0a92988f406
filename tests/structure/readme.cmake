# The programs in all READMEs compile and run, as a user would have them. A program is a ```cpp block behind the line
# `<!-- runs -->`, or `<!-- runs: REGEX -->` where its output has to match (`.` matches the end of a line, too); it has to
# exit with 0. Test `readme.FOLDER.N` is the Nth program of FOLDER/README.md, `readme.N` of that at the top; programs run
# in the repository's folder.
file(GLOB_RECURSE readmes CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/bench/README.md ${PROJECT_SOURCE_DIR}/examples/README.md ${PROJECT_SOURCE_DIR}/include/README.md
  ${PROJECT_SOURCE_DIR}/maps/README.md ${PROJECT_SOURCE_DIR}/tests/README.md)
list(PREPEND readmes README.md)

add_library(readme_options INTERFACE)
target_link_libraries(readme_options INTERFACE cambium::opendrive)
if(TARGET cambium::compiled)
  target_link_libraries(readme_options INTERFACE cambium::compiled)
endif()
target_compile_options(readme_options INTERFACE ${CAMBIUM_WARNINGS} -Werror -O0)
left_to_all("programs of READMEs without a precompiled header" "here <cambium/cambium.hpp> is read once")
if(CAMBIUM_QUICK_TESTS)
  write_if_new(${structure_binary}/readme_header.cpp "")
  add_library(readme_header OBJECT ${structure_binary}/readme_header.cpp)
  target_link_libraries(readme_header PRIVATE readme_options)
  target_precompile_headers(readme_header PRIVATE <cambium/cambium.hpp>)
endif()

# add_readme_program(NAME EXPECTED SOURCE)
function(add_readme_program name expected source)
  string(REPLACE "." "_" target ${name})
  write_if_new(${structure_binary}/${target}.cpp "${source}")
  add_executable(${target} ${structure_binary}/${target}.cpp)
  target_link_libraries(${target} PRIVATE readme_options)
  if(TARGET readme_header)
    target_precompile_headers(${target} REUSE_FROM readme_header)
  endif()
  add_program_test(${name} ${target} ${CMAKE_COMMAND} "-DPROGRAM=$<TARGET_FILE:${target}>" "-DEXPECTED=${expected}"
    -P ${structure_source}/run_readme_program.cmake)
  # Those of the front page with libc++, and those that need only Eigen and Boost by MinGW's g++ under Wine.
  set(run bash ${structure_source}/run_elsewhere.sh ${structure_binary}/${target}.cpp "${expected}")
  if(libcxx_command AND name MATCHES "^readme[.][0-9]+$")
    add_timed_test(${name}.libc++ ${run} "" ${libcxx_command} -lpugixml)
  endif()
  if(mingw_command AND CAMBIUM_CHECK_wine AND NOT source MATCHES "opendrive|lanelet|json|benchmark|snapshot|scenario")
    add_timed_test(${name}.mingw ${run} ${CAMBIUM_CHECK_wine} ${mingw_command} -static)
  endif()
endfunction()

# add_readme_programs(README): those of one file.
function(add_readme_programs readme)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${readme})
  file(READ ${PROJECT_SOURCE_DIR}/${readme} rest)
  get_filename_component(folder ${readme} DIRECTORY)
  get_filename_component(folder "${folder}" NAME)
  set(name readme)
  if(folder)
    string(APPEND name .${folder})
  endif()
  set(number 0)
  while(TRUE)
    string(FIND "${rest}" "\n<!-- runs" marker)
    if(marker EQUAL -1)
      return()
    endif()
    math(EXPR number "${number} + 1")
    string(SUBSTRING "${rest}" ${marker} -1 rest)
    string(FIND "${rest}" " -->\n```cpp\n" begin)
    if(begin EQUAL -1)
      message(FATAL_ERROR "${readme}: there is no program right behind a line <!-- runs -->")
    endif()
    string(SUBSTRING "${rest}" 0 ${begin} expected)
    string(REGEX REPLACE "^\n<!-- runs:? ?" "" expected "${expected}")
    math(EXPR begin "${begin} + 12")
    string(SUBSTRING "${rest}" ${begin} -1 rest)
    string(FIND "${rest}" "```" end)
    string(SUBSTRING "${rest}" 0 ${end} program)
    string(SUBSTRING "${rest}" ${end} -1 rest)
    add_readme_program(${name}.${number} "${expected}" "${program}")
  endwhile()
endfunction()

foreach(readme IN LISTS readmes)
  add_readme_programs(${readme})
endforeach()

# No block of C++ is left out, and what the READMEs link to is there.
add_test(NAME readme.links_and_marks
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -P ${structure_source}/check_readmes.cmake)
