# Whether states that a release build records thaw bit-equal in other builds. Each build is a command of its own, with
# compilers and flags that are not the project's; the ctest of a build makes it first.
left_to_all("snapshot.builds.*" "five builds of one program; here golden files, and damaged ones, in snapshot")
if(CAMBIUM_QUICK_TESTS)
  return()
endif()
set(builds_source ${CMAKE_CURRENT_LIST_DIR})
set(builds_binary ${CMAKE_CURRENT_BINARY_DIR}/snapshot_builds)
file(MAKE_DIRECTORY ${builds_binary})

# add_snapshot_build(NAME COMPILER OPTION...): a program that records and thaws, and the test that builds it.
function(add_snapshot_build name compiler)
  set(program ${builds_binary}/${name})
  add_custom_command(OUTPUT ${program}
    COMMAND ${compiler} @${compile_flags} ${CAMBIUM_WARNINGS} -Werror -DCAMBIUM_SOURCE_DIR="${PROJECT_SOURCE_DIR}" -MMD
      -MT ${program} -MF ${program}.d -ffp-contract=off ${ARGN} ${builds_source}/main.cpp -o ${program} -lboost_serialization -lpugixml
      -pthread
    DEPENDS ${builds_source}/main.cpp ${compile_flags} DEPFILE ${program}.d COMMENT "snapshot build: ${name}" VERBATIM)
  add_custom_target(snapshot_build_${name} DEPENDS ${program})
  add_build_test(snapshot.builds.${name}.build snapshot_build_${name})
  set_tests_properties(snapshot.builds.${name}.build PROPERTIES FIXTURES_SETUP snapshot_build_${name})
endfunction()

# add_thaw_test(NAME COMPILER OPTION...): such a build, and whether the release's states come out bit-equal in it.
function(add_thaw_test name)
  add_snapshot_build(${name} ${ARGN})
  add_timed_test(snapshot.builds.${name} ${builds_binary}/${name} thaw ${builds_binary}/recorded)
  set_tests_properties(snapshot.builds.${name} PROPERTIES
    FIXTURES_REQUIRED "snapshot_recorded;snapshot_build_${name}")
endfunction()

if(TARGET cambium_snapshot AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" AND NOT WIN32)
  add_snapshot_build(release ${CMAKE_CXX_COMPILER} -O2 -DNDEBUG)
  add_timed_test(snapshot.builds.record ${builds_binary}/release record ${builds_binary}/recorded)
  set_tests_properties(snapshot.builds.record PROPERTIES
    FIXTURES_REQUIRED snapshot_build_release FIXTURES_SETUP snapshot_recorded)

  add_thaw_test(debug ${CMAKE_CXX_COMPILER} -O0 -g)
  set(clang ${CAMBIUM_CHECK_clang++-14})
  if(CAMBIUM_CHECK_clang++-19)
    set(clang ${CAMBIUM_CHECK_clang++-19})
  endif()
  if(clang)
    add_thaw_test(clang ${clang} -O2)
    # Contracted multiplications give other bits. The test says how far the cycles are then apart, and fails only where a
    # file cannot be restored.
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND EXISTS /proc/cpuinfo)
      file(STRINGS /proc/cpuinfo cpu_flags REGEX "^flags.* fma " LIMIT_COUNT 1)
      if(cpu_flags)
        add_thaw_test(contracted ${clang} -O1 -mfma -ffp-contract=fast)
        set_tests_properties(snapshot.builds.contracted PROPERTIES
          PASS_REGULAR_EXPRESSION "of 240 cycles came out bit-equal")
      endif()
    endif()
  endif()
  if(CAMBIUM_FUZZING_CLANG)  # a clang with sanitizers; g++ takes ten times as long to compile with these
    add_thaw_test(sanitizers ${CAMBIUM_FUZZING_CLANG} -O1 -g1
      -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all)
    # 100 000 damaged files, of which every fourth has a right checksum again, so that the archive is read; and 7 500
    # worlds with changed numbers.
    add_timed_test(snapshot.builds.mutants ${builds_binary}/sanitizers mutate ${builds_binary}/recorded 100000)
    set_tests_properties(snapshot.builds.mutants PROPERTIES
      FIXTURES_REQUIRED "snapshot_recorded;snapshot_build_sanitizers")
  else()
    add_test(NAME snapshot.builds.sanitizers COMMAND ${CMAKE_COMMAND} -E echo "skipped: no clang with sanitizers here")
    set_tests_properties(snapshot.builds.sanitizers PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
  endif()
endif()
