# Tests of the house itself: headers alone and together, warnings per compiler, wrong programs, consumers, READMEs.
# What only has to be compiled is compiled by targets outside `all`, with a stamp per check, so that a second run is quick;
# the ctest of a check builds its target.
set(structure_source ${CMAKE_CURRENT_LIST_DIR})
set(structure_binary ${CMAKE_CURRENT_BINARY_DIR}/structure)
set(compile_flags ${PROJECT_BINARY_DIR}/compile_flags.txt)

file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/include/*.hpp)
list(SORT headers)

# write_if_new(FILE TEXT): leaves the file alone when it reads so already.
function(write_if_new file text)
  if(EXISTS ${file})
    file(READ ${file} before)
  endif()
  if(NOT EXISTS ${file} OR NOT before STREQUAL text)
    file(WRITE ${file} "${text}")
  endif()
endfunction()

if(CMAKE_GENERATOR MATCHES "Ninja")
  set(keep_going -- -k 0)
elseif(CMAKE_GENERATOR MATCHES "Makefiles")
  set(keep_going -- --keep-going)
endif()

# add_build_test(NAME TARGET): a ctest that builds a target of this build tree.
function(add_build_test name target)
  add_timed_test(${name} ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target ${target} --parallel 2 ${keep_going})
  # Compiling hundreds of headers may take a slow machine longer than the 10 minutes that a test has elsewhere.
  set_tests_properties(${name} PROPERTIES RESOURCE_LOCK cambium_build_tree TIMEOUT 2400)
endfunction()

# add_syntax_check(STAMP_VARIABLE FOLDER COMPILER SOURCE OPTION... [DEPENDS FILE...]): warning-free under COMPILER;
# STAMP_VARIABLE is what to depend on.
function(add_syntax_check stamp_variable folder compiler source)
  cmake_parse_arguments(PARSE_ARGV 4 check "" "" "DEPENDS")
  get_filename_component(source_name ${source} NAME_WE)
  set(stamp ${structure_binary}/stamps/${folder}/${source_name})
  file(MAKE_DIRECTORY ${structure_binary}/stamps/${folder})
  add_custom_command(OUTPUT ${stamp}
    COMMAND ${compiler} @${compile_flags} ${CAMBIUM_WARNINGS} -Werror -MMD -MT ${stamp} -MF ${stamp}.d
      ${check_UNPARSED_ARGUMENTS} ${source}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${source} ${compile_flags} ${compiler} ${check_DEPENDS} DEPFILE ${stamp}.d
    COMMENT "${folder}: ${source_name}" VERBATIM)
  set(${stamp_variable} ${stamp} PARENT_SCOPE)
endfunction()

foreach(name g++ clang++-14 clang++-19)
  find_program(CAMBIUM_CHECK_${name} ${name})
  mark_as_advanced(CAMBIUM_CHECK_${name})
endforeach()

# Every header alone, under the compiler that is quickest at it; the others see all at once below. What a header includes
# may as well be read before it, since that is itself checked alone: so the costliest of that is read once, precompiled.
# Definitions of cold code, too, are checked alone, and not wherever they are included.
set(alone_compiler ${CMAKE_CXX_COMPILER})
set(alone_bases "")  # of those that a header includes, the last is the most
if(CAMBIUM_CHECK_clang++-14)
  set(alone_compiler ${CAMBIUM_CHECK_clang++-14})
  set(alone_bases cambium/geometry/pose.hpp cambium/map/lanes/lane.hpp cambium/map/map.hpp cambium/behavior/view.hpp
    cambium/world/detail/entering.hpp cambium/planner/mcts/mcts_workspace.hpp)
endif()

# reach(VARIABLE HEADER): all that HEADER includes of cambium, directly or not, but for definitions of cold code.
function(reach variable header)
  get_property(known GLOBAL PROPERTY reach_${header} SET)
  if(NOT known)
    file(STRINGS ${PROJECT_SOURCE_DIR}/include/${header} lines REGEX "^#include \"cambium/")
    list(FILTER lines EXCLUDE REGEX "_impl.hpp")
    set(all "")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" next "${line}")
      reach(more ${next})
      list(APPEND all ${next} ${more})
    endforeach()
    list(REMOVE_DUPLICATES all)
    set_property(GLOBAL PROPERTY reach_${header} "${all}")
  endif()
  get_property(all GLOBAL PROPERTY reach_${header})
  set(${variable} "${all}" PARENT_SCOPE)
endfunction()

left_to_all("each header alone" "300 compilations; here those of whole rooms")
set(all_headers "")
set(alone_stamps "")
foreach(header IN LISTS headers)
  string(APPEND all_headers "#include <${header}>\n")
  if(CAMBIUM_QUICK_TESTS AND NOT header MATCHES "^cambium/[a-z]+\\.hpp$" AND NOT header IN_LIST alone_bases)
    continue()
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/${header})
  string(REGEX REPLACE "[/.]" "_" name ${header})
  set(source ${structure_binary}/alone/${name}.cpp)
  write_if_new(${source} "#include <${header}>\n")
  set(before "")
  reach(included ${header})
  foreach(base IN LISTS alone_bases)
    if(base IN_LIST included)
      string(REGEX REPLACE "[/.]" "_" before ${base})
    endif()
  endforeach()
  if(header IN_LIST alone_bases)  # clang 14 falls over precompiled headers that begin with others
    set(options -x c++-header -o ${structure_binary}/alone/${name}.pch)
  elseif(before)
    set(options -fsyntax-only -include-pch ${structure_binary}/alone/${before}.pch
      DEPENDS ${structure_binary}/stamps/alone/${before})
  else()
    set(options -fsyntax-only)
  endif()
  add_syntax_check(stamp alone ${alone_compiler} ${source} -DCAMBIUM_COMPILED ${options})
  list(APPEND alone_stamps ${stamp})
endforeach()
add_custom_target(structure_headers_alone DEPENDS ${alone_stamps})
add_build_test(structure.headers_alone structure_headers_alone)

# All headers twice in one program: compiled once, the object linked beside a copy of itself.
write_if_new(${structure_binary}/all_headers.cpp "${all_headers}")
left_to_all(structure.headers_twice "compiles all headers; here structure.two_units.mixed, of two sources")
if(NOT CAMBIUM_QUICK_TESTS)
  write_if_new(${structure_binary}/twice.cpp "int main() {}\n")
  add_library(structure_all_headers OBJECT EXCLUDE_FROM_ALL ${structure_binary}/all_headers.cpp)
  target_link_libraries(structure_all_headers PRIVATE cambium::benchmark_main)
  target_compile_options(structure_all_headers PRIVATE -O0 ${CAMBIUM_WARNINGS} -Werror)
  add_custom_command(OUTPUT ${structure_binary}/all_headers_again.o
    COMMAND ${CMAKE_COMMAND} -E copy $<TARGET_OBJECTS:structure_all_headers> ${structure_binary}/all_headers_again.o
    DEPENDS structure_all_headers $<TARGET_OBJECTS:structure_all_headers> VERBATIM)
  add_executable(structure_headers_twice EXCLUDE_FROM_ALL ${structure_binary}/twice.cpp
    $<TARGET_OBJECTS:structure_all_headers> ${structure_binary}/all_headers_again.o)
  target_link_libraries(structure_headers_twice PRIVATE cambium::benchmark_main)
  add_build_test(structure.headers_twice structure_headers_twice)
endif()

# A program of two translation units, one of which makes the map: header-only, with cold code compiled apart, and with one
# unit of each kind.
add_library(structure_drive OBJECT EXCLUDE_FROM_ALL ${structure_source}/two_units/drive.cpp)
target_link_libraries(structure_drive PRIVATE cambium::cambium)
target_compile_options(structure_drive PRIVATE -O0 ${CAMBIUM_WARNINGS} -Werror)
left_to_all("structure.two_units.header_only, .compiled" "here .mixed, of one unit of each kind")
set(kinds mixed)
if(NOT CAMBIUM_QUICK_TESTS)
  list(APPEND kinds header_only compiled)
endif()
foreach(kind IN LISTS kinds)
  add_executable(structure_two_units_${kind} EXCLUDE_FROM_ALL ${structure_source}/two_units/main.cpp)
  target_compile_definitions(structure_two_units_${kind} PRIVATE CAMBIUM_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(structure_two_units_${kind} PRIVATE -O0 ${CAMBIUM_WARNINGS} -Werror)
  add_program_test(structure.two_units.${kind} structure_two_units_${kind} $<TARGET_FILE:structure_two_units_${kind}>)
endforeach()
target_link_libraries(structure_two_units_mixed PRIVATE structure_drive cambium::compiled_opendrive)
if(NOT CAMBIUM_QUICK_TESTS)
  target_link_libraries(structure_two_units_header_only PRIVATE structure_drive cambium::opendrive)
  target_sources(structure_two_units_compiled PRIVATE ${structure_source}/two_units/drive.cpp)
  target_link_libraries(structure_two_units_compiled PRIVATE cambium::compiled)
endif()

# The C interface, from C.
include(CheckLanguage)
check_language(C)
if(CMAKE_C_COMPILER)
  enable_language(C)
  add_executable(structure_c_interface EXCLUDE_FROM_ALL ${structure_source}/c_interface.c)
  set_target_properties(structure_c_interface PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF LINKER_LANGUAGE CXX)
  target_compile_definitions(structure_c_interface PRIVATE CAMBIUM_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(structure_c_interface PRIVATE -Wall -Wextra -Wpedantic -Werror)
  target_link_libraries(structure_c_interface PRIVATE cambium::compiled_predictor)
  add_program_test(structure.c_interface structure_c_interface $<TARGET_FILE:structure_c_interface>)
endif()

# All headers at once, free of warnings under each compiler there is; g++ has just compiled them where it is the project's.
left_to_all("structure.warnings.*" "all headers under g++ and two clangs; here what the tests compile, by the project's compiler")
set(warning_compilers "")
if(NOT CAMBIUM_QUICK_TESTS)
  set(warning_compilers g++ clang++-14 clang++-19)
endif()
foreach(name IN LISTS warning_compilers)
  if(name STREQUAL "g++" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_build_test(structure.warnings.${name} structure_all_headers)
  elseif(CAMBIUM_CHECK_${name})
    add_syntax_check(stamp ${name} ${CAMBIUM_CHECK_${name}} ${structure_binary}/all_headers.cpp -fsyntax-only)
    add_custom_target(structure_warnings_${name} DEPENDS ${stamp})
    add_build_test(structure.warnings.${name} structure_warnings_${name})
  else()
    add_test(NAME structure.warnings.${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: no ${name} here")
    set_tests_properties(structure.warnings.${name} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
  endif()
endforeach()

# The same by the compilers of other systems: clang with libc++, as macOS has it, and MinGW's g++, as for Windows, which has
# no POSIX. Boost before 1.80 needs what libc++ has removed.
left_to_all("structure.warnings.libc++, .mingw" "all headers, once more")
find_program(CAMBIUM_CHECK_mingw x86_64-w64-mingw32-g++-posix)
find_program(CAMBIUM_CHECK_wine wine64 PATHS /usr/lib/wine)
mark_as_advanced(CAMBIUM_CHECK_mingw CAMBIUM_CHECK_wine)
set(libcxx_command "")
set(mingw_command "")
if(NOT CAMBIUM_QUICK_TESTS)
  file(GLOB libcxx_folders /usr/lib/llvm-19/include/c++/v1)
  if(CAMBIUM_CHECK_clang++-19 AND libcxx_folders)
    set(libcxx_options -stdlib=libc++ -D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION)
    set(libcxx_command ${CAMBIUM_CHECK_clang++-19} @${compile_flags} ${libcxx_options})
    add_syntax_check(stamp libc++ ${CAMBIUM_CHECK_clang++-19} ${structure_binary}/all_headers.cpp -fsyntax-only
      ${libcxx_options})
    add_custom_target(structure_warnings_libcxx DEPENDS ${stamp})
    add_build_test(structure.warnings.libc++ structure_warnings_libcxx)
  endif()
  if(CAMBIUM_CHECK_mingw)
    # Header-only libraries without the headers of this system's C library beside them.
    set(alone_libraries ${structure_binary}/libraries)
    file(MAKE_DIRECTORY ${alone_libraries})
    foreach(library boost nlohmann CLI pugixml.hpp pugiconfig.hpp sqlite3.h)
      if(EXISTS /usr/include/${library})
        file(CREATE_LINK /usr/include/${library} ${alone_libraries}/${library} SYMBOLIC)
      endif()
    endforeach()
    set(mingw_command ${CAMBIUM_CHECK_mingw} @${compile_flags} -isystem ${alone_libraries})
    string(REGEX REPLACE "#include <cambium/benchmark/(detail/job_process|run_on_processes|run_on_ranks|benchmark_on_ranks).hpp>\n" ""
      windows_headers "${all_headers}")
    write_if_new(${structure_binary}/windows_headers.cpp "${windows_headers}")
    add_syntax_check(stamp mingw ${CAMBIUM_CHECK_mingw} ${structure_binary}/windows_headers.cpp -fsyntax-only
      -isystem ${alone_libraries})
    add_custom_target(structure_warnings_mingw DEPENDS ${stamp})
    add_build_test(structure.warnings.mingw structure_warnings_mingw)
  endif()
  foreach(name libc++ mingw)
    if(NOT TEST structure.warnings.${name})
      add_test(NAME structure.warnings.${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: no ${name} here")
      set_tests_properties(structure.warnings.${name} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
    endif()
  endforeach()
endif()

# Programs that must not compile, and the sentence that each must get, from one compiler of each kind; in the quick size
# from the quickest. They begin with wrong.hpp, which is precompiled.
left_to_all("structure.wrong.* by a second compiler" "here by clang++ where it is there, else by g++")
set(wrong_compilers "")
foreach(name clang++-14 clang++-19)
  if(CAMBIUM_CHECK_${name} AND NOT wrong_compilers)
    set(wrong_compilers ${CAMBIUM_CHECK_${name}})
  endif()
endforeach()
if(NOT wrong_compilers OR NOT CAMBIUM_QUICK_TESTS)
  if(CAMBIUM_CHECK_g++)
    list(APPEND wrong_compilers ${CAMBIUM_CHECK_g++})
  else()
    list(APPEND wrong_compilers ${CMAKE_CXX_COMPILER})
  endif()
endif()
list(REMOVE_DUPLICATES wrong_compilers)
set(wrong_header ${structure_binary}/wrong/all.hpp)
write_if_new(${wrong_header} "#include \"${structure_source}/wrong.hpp\"\n")
set(wrong_options -DCAMBIUM_COMPILED -O0)
set(wrong_headers "")
set(wrong_commands "")
foreach(compiler IN LISTS wrong_compilers)
  if(compiler MATCHES "clang")
    get_filename_component(name ${compiler} NAME)
    set(precompiled ${structure_binary}/wrong/all.${name}.pch)
    # clang instantiates templates in a check of the syntax, too.
    set(command ${compiler} @${compile_flags} ${wrong_options} -fsyntax-only -include-pch ${precompiled})
  else()
    set(precompiled ${wrong_header}.gch)
    set(command ${compiler} @${compile_flags} ${wrong_options} -S -o /dev/null -include ${wrong_header})
  endif()
  add_custom_command(OUTPUT ${precompiled}
    COMMAND ${compiler} @${compile_flags} ${wrong_options} -x c++-header ${wrong_header} -MMD -MT ${precompiled}
      -MF ${precompiled}.d -o ${precompiled}
    DEPENDS ${wrong_header} ${compile_flags} ${compiler} DEPFILE ${precompiled}.d COMMENT "header of the wrong programs" VERBATIM)
  list(APPEND wrong_headers ${precompiled})
  list(JOIN command "|" command)
  list(APPEND wrong_commands ${command})
endforeach()
add_custom_target(structure_wrong_headers DEPENDS ${wrong_headers})
add_build_test(structure.wrong_headers structure_wrong_headers)
set_tests_properties(structure.wrong_headers PROPERTIES FIXTURES_SETUP structure_wrong_headers)
function(add_wrong_program name source)
  add_timed_test(structure.wrong.${name} bash ${structure_source}/wrong.sh ${source} ${wrong_commands})
  set_tests_properties(structure.wrong.${name} PROPERTIES FIXTURES_REQUIRED structure_wrong_headers)
endfunction()
file(GLOB programs CONFIGURE_DEPENDS ${structure_source}/wrong/*.cpp)
foreach(program IN LISTS programs)
  get_filename_component(name ${program} NAME_WE)
  add_wrong_program(${name} ${program})
endforeach()
add_wrong_program(harness_compiles ${structure_source}/harness/compiles.cpp)
set_tests_properties(structure.wrong.harness_compiles PROPERTIES PASS_REGULAR_EXPRESSION "it compiles, but must not")
add_wrong_program(harness_other_sentence ${structure_source}/harness/other_sentence.cpp)
set_tests_properties(structure.wrong.harness_other_sentence PROPERTIES PASS_REGULAR_EXPRESSION "does not say 'blue'")
add_wrong_program(harness_no_sentence ${structure_source}/harness/no_sentence.cpp)
set_tests_properties(structure.wrong.harness_no_sentence PROPERTIES PASS_REGULAR_EXPRESSION "first line must be")

add_timed_test(structure.wrong.older_standard bash ${structure_source}/wrong.sh ${structure_source}/harness/older_standard.cpp
  "${CMAKE_CXX_COMPILER}|-std=c++17|-I${PROJECT_SOURCE_DIR}/include|-fsyntax-only")

# Traffic drives with the same bits, whatever the compiler, the processor and the standard library.
left_to_all("structure.same_bits" "compiles the steps of seven drivers five times, 8 minutes of one core")
if(NOT CAMBIUM_QUICK_TESTS AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  get_target_property(eigen_dir Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  set(same_bits_compilers ${CMAKE_CXX_COMPILER})
  foreach(name g++ clang++-14 clang++-19)
    if(CAMBIUM_CHECK_${name} AND NOT (name STREQUAL "g++" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
      list(APPEND same_bits_compilers ${CAMBIUM_CHECK_${name}})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES same_bits_compilers)
  list(GET eigen_dir 0 eigen_dir)
  add_timed_test(structure.same_bits bash ${structure_source}/same_bits.sh ${structure_source}/same_bits.cpp
    ${PROJECT_SOURCE_DIR}/include ${eigen_dir} ${structure_binary}/same_bits ${same_bits_compilers})
  set_tests_properties(structure.same_bits PROPERTIES TIMEOUT 2400)
endif()

# Two versions in one program.
left_to_all("structure.two_versions" "compiles a program by two versions of the headers")
if(NOT CAMBIUM_QUICK_TESTS AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  get_target_property(eigen_dir Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  list(GET eigen_dir 0 eigen_dir)
  add_timed_test(structure.two_versions bash ${structure_source}/two_versions.sh ${structure_source}/exporting/steps.cpp
    ${PROJECT_SOURCE_DIR}/include ${structure_binary}/two_versions ${CMAKE_CXX_COMPILER} -std=c++20 -isystem ${eigen_dir})
endif()

# What examples/packaging holds.
add_timed_test(structure.packaging ${CMAKE_COMMAND} -DFOLDER=${PROJECT_SOURCE_DIR}/examples/packaging -DVERSION=${PROJECT_VERSION}
  -DBUILD=${structure_binary}/packaging -DCOMPILER=${CMAKE_CXX_COMPILER} -P ${structure_source}/packaging.cmake)
left_to_all("structure.single_header" "compiles a program with all of <cambium/cambium.hpp> in one file")
if(NOT CAMBIUM_QUICK_TESTS)
  add_timed_test(structure.single_header bash ${structure_source}/single_header.sh ${PROJECT_SOURCE_DIR}
    ${structure_binary}/readme_1.cpp ${structure_binary}/single_header ${CMAKE_CXX_COMPILER} @${compile_flags})
endif()

# A project that uses cambium, by add_subdirectory and by find_package.
function(add_consumer name)
  add_timed_test(structure.consumer.${name} ${CMAKE_CTEST_COMMAND} --build-and-test ${structure_source}/consumer ${structure_binary}/consumer_${name}
      --build-generator ${CMAKE_GENERATOR} --build-noclean
      --build-options -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
        -DCONSUMER_VERSION=${PROJECT_VERSION} ${ARGN}
      --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
endfunction()
add_consumer(subdirectory -DCONSUMER_SUBDIRECTORY=${PROJECT_SOURCE_DIR} "-DCONSUMER_TARGETS=geometry$<SEMICOLON>cambium")
# Of a clang, which warns where Eigen is no system's.
set(check_clang "")
if(CAMBIUM_CHECK_clang++-14)
  set(check_clang ${CAMBIUM_CHECK_clang++-14})
elseif(CAMBIUM_CHECK_clang++-19)
  set(check_clang ${CAMBIUM_CHECK_clang++-19})
endif()
set(no_pugixml -DCMAKE_DISABLE_FIND_PACKAGE_pugixml=ON)
get_target_property(eigen_dir Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
set(own_eigen -DCONSUMER_SUBDIRECTORY=${PROJECT_SOURCE_DIR} -DCONSUMER_TARGETS=cambium -DCONSUMER_EIGEN=${eigen_dir})
if(check_clang)
  list(APPEND own_eigen -DCMAKE_CXX_COMPILER=${check_clang})
endif()
add_consumer(subdirectory_with_own_eigen ${own_eigen})
add_consumer(subdirectory_without_pugixml ${no_pugixml} -DCONSUMER_SUBDIRECTORY=${PROJECT_SOURCE_DIR}
  -DCONSUMER_TARGETS=cambium)
add_consumer(subdirectory_links_opendrive_without_pugixml ${no_pugixml} -DCONSUMER_SUBDIRECTORY=${PROJECT_SOURCE_DIR}
  -DCONSUMER_TARGETS=opendrive)
set(needs_pugixml "which[ \n]+cambium::opendrive[ \n]+needs[ \n]+and[ \n]+CMake[ \n]+did[ \n]+not[ \n]+find:[ \n]+install")
set_tests_properties(structure.consumer.subdirectory_links_opendrive_without_pugixml PROPERTIES
  PASS_REGULAR_EXPRESSION "${needs_pugixml}")
# match_words(VARIABLE WORD...): matches the sentence of these words, wherever CMake breaks its lines.
function(match_words variable)
  list(JOIN ARGN "[ \n]+" sentence)
  set(${variable} "${sentence}" PARENT_SCOPE)
endfunction()
foreach(case "json|nlohmann_json|nlohmann_json .nlohmann-json3-dev." "benchmark|SQLite3|SQLite .libsqlite3-dev."
    "benchmark_main|CLI11|CLI11 .libcli11-dev." "snapshot|boost_serialization|Boost.Serialization .libboost-serialization-dev.")
  string(REGEX REPLACE "[|].*" "" part "${case}")
  string(REGEX REPLACE "^[^|]*[|]([^|]*)[|].*" "\\1" package "${case}")
  string(REGEX REPLACE ".*[|]" "" words "${case}")
  add_consumer(subdirectory_links_${part}_without_${package} -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON
    -DCONSUMER_SUBDIRECTORY=${PROJECT_SOURCE_DIR} -DCONSUMER_TARGETS=${part})
  string(REPLACE " " ";" words "${words}")
  match_words(sentence cambium::${part} needs ${words}, which CMake did not find)
  set_tests_properties(structure.consumer.subdirectory_links_${part}_without_${package} PROPERTIES
    PASS_REGULAR_EXPRESSION "${sentence}")
endforeach()
if(CAMBIUM_INSTALL)
  set(install_tree ${structure_binary}/install)
  add_test(NAME structure.install
    COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --config $<CONFIG> --prefix ${install_tree})
  add_test(NAME structure.install_anew COMMAND ${CMAKE_COMMAND} -E rm -rf ${install_tree})
  set_tests_properties(structure.install_anew PROPERTIES FIXTURES_SETUP cambium_install)
  set_tests_properties(structure.install PROPERTIES FIXTURES_SETUP cambium_install DEPENDS structure.install_anew)
  set(package -DCMAKE_PREFIX_PATH=${install_tree})
  left_to_all("cambium::compiled in structure.consumer.package" "compiles all of it; here none of it, but in all other tests")
  set(compiled "$<SEMICOLON>compiled")
  if(CAMBIUM_QUICK_TESTS)
    set(compiled "")
  endif()
  add_consumer(package ${package} "-DCONSUMER_COMPONENTS=opendrive${compiled}" "-DCONSUMER_TARGETS=geometry${compiled}")
  add_timed_test(structure.debian_package bash ${structure_source}/debian_package.sh ${PROJECT_BINARY_DIR}
    ${structure_binary}/debian_package ${structure_source}/consumer ${CMAKE_CXX_COMPILER})
  set_tests_properties(structure.debian_package PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
  set(package_of_sources ${package})
  left_to_all("structure.exporting.*" "a user's installed libraries that link cambium::compiled, which is not installed here")
  if(CAMBIUM_INSTALL_COMPILED)
    foreach(type STATIC SHARED)
      add_timed_test(structure.exporting.${type} bash ${structure_source}/exporting.sh ${structure_source}/exporting
        ${structure_binary}/exporting_${type} ${type} ${install_tree} ${CMAKE_CXX_COMPILER})
      set_tests_properties(structure.exporting.${type} PROPERTIES FIXTURES_REQUIRED cambium_install)
    endforeach()
    # The same without the compiled libraries, which are then made in the user's build.
    set(package_of_sources -DCMAKE_PREFIX_PATH=${install_tree}_of_sources)
    add_test(NAME structure.install_of_sources COMMAND bash -c
      "rm -rf '${install_tree}_of_sources' && cp -r '${install_tree}' '${install_tree}_of_sources' && rm -r '${install_tree}_of_sources/${CMAKE_INSTALL_LIBDIR}'")
    set_tests_properties(structure.install_of_sources PROPERTIES FIXTURES_SETUP cambium_install DEPENDS structure.install)
  endif()
  add_consumer(package_without_pugixml ${package_of_sources} ${no_pugixml} "-DCONSUMER_TARGETS=cambium${compiled}")
  add_consumer(package_lacks_opendrive ${package} ${no_pugixml} -DCONSUMER_COMPONENTS=opendrive)
  add_consumer(package_links_opendrive_without_pugixml ${package} ${no_pugixml} -DCONSUMER_TARGETS=opendrive)
  add_timed_test(structure.installed_files bash ${structure_source}/installed.sh ${PROJECT_SOURCE_DIR} ${install_tree}
    ${CMAKE_CXX_COMPILER} ${check_clang})
  set_tests_properties(structure.installed_files PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
  add_consumer(package_lacks_benchmark ${package} -DCMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON -DCONSUMER_COMPONENTS=benchmark)
  match_words(sentence cambium's component benchmark needs SQLite .libsqlite3-dev., which CMake did not find)
  set_tests_properties(structure.consumer.package_lacks_benchmark PROPERTIES PASS_REGULAR_EXPRESSION "${sentence}")
  set_tests_properties(structure.consumer.package structure.consumer.package_without_pugixml
    structure.consumer.package_lacks_benchmark structure.consumer.package_lacks_opendrive structure.consumer.package_links_opendrive_without_pugixml
    structure.installed_files PROPERTIES FIXTURES_REQUIRED cambium_install)
  set_tests_properties(structure.consumer.package_lacks_opendrive PROPERTIES
    PASS_REGULAR_EXPRESSION "component[ \n]+opendrive[ \n]+needs[ \n]+pugixml,[ \n]+which[ \n]+CMake[ \n]+did[ \n]+not[ \n]+find")
  set_tests_properties(structure.consumer.package_links_opendrive_without_pugixml PROPERTIES
    PASS_REGULAR_EXPRESSION "${needs_pugixml}")
endif()

include(${CMAKE_CURRENT_LIST_DIR}/readme.cmake)
