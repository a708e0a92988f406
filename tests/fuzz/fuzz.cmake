# The fuzzer of the OpenDRIVE reader, where there is a clang with its fuzzing and sanitizer libraries. A target outside
# `all`; its ctest builds it and runs it for a short while, with a fixed seed. Elsewhere the test is skipped.
left_to_all(fuzz.opendrive "needs a build with sanitizers; here damaged files in map")
if(CAMBIUM_QUICK_TESTS)
  return()
endif()
set(fuzz_source ${CMAKE_CURRENT_LIST_DIR})
set(fuzz_flags -std=c++20 -O1 -g1 -fsanitize=fuzzer,address,undefined,float-cast-overflow -fno-sanitize-recover=all
  -fno-sanitize-coverage=trace-cmp)  # the mutator knows the words that comparisons would tell it

find_library(CAMBIUM_FUZZ_PUGIXML pugixml)
mark_as_advanced(CAMBIUM_FUZZ_PUGIXML)
if(NOT DEFINED CAMBIUM_FUZZING_CLANG)  # the first that has its libraries
  set(probe ${CMAKE_CURRENT_BINARY_DIR}/fuzz_probe)
  file(WRITE ${probe}.cpp
    "#include <cstddef>\n#include <vector>\nextern \"C\" int LLVMFuzzerTestOneInput(unsigned char const*, std::size_t) { return std::vector<int>().size(); }\n")
  set(found "")
  foreach(name clang++-19 clang++-14 clang++)
    find_program(candidate ${name} NO_CACHE)
    if(candidate AND NOT found)
      execute_process(COMMAND ${candidate} ${fuzz_flags} ${probe}.cpp -o ${probe}
        RESULT_VARIABLE probe_result OUTPUT_QUIET ERROR_QUIET)
      if(probe_result EQUAL 0)
        set(found ${candidate})
      endif()
    endif()
    unset(candidate)
  endforeach()
  set(CAMBIUM_FUZZING_CLANG "${found}" CACHE INTERNAL "a clang that makes programs that fuzz; empty: there is none")
endif()

if(CAMBIUM_FUZZING_CLANG AND CAMBIUM_FUZZ_PUGIXML)
  set(fuzzer ${CMAKE_CURRENT_BINARY_DIR}/fuzz/opendrive_fuzz)
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/fuzz/found)  # what is new goes there
  # Another compiler than the project's, perhaps: so a command instead of a target of the project's own.
  add_custom_command(OUTPUT ${fuzzer}
    COMMAND ${CAMBIUM_FUZZING_CLANG} ${fuzz_flags} @${compile_flags} ${CAMBIUM_WARNINGS} -Werror -MMD -MT ${fuzzer}
      -MF ${fuzzer}.d ${fuzz_source}/opendrive_fuzz.cpp ${CAMBIUM_FUZZ_PUGIXML} -o ${fuzzer}
    DEPENDS ${fuzz_source}/opendrive_fuzz.cpp ${compile_flags} DEPFILE ${fuzzer}.d
    COMMENT "opendrive_fuzz" VERBATIM)
  add_custom_target(opendrive_fuzz DEPENDS ${fuzzer})
  add_build_test(fuzz.build opendrive_fuzz)
  set_tests_properties(fuzz.build PROPERTIES FIXTURES_SETUP opendrive_fuzz)
  add_timed_test(fuzz.opendrive ${fuzzer} -max_len=6000 -seed=1 -runs=4000 -max_total_time=30 -timeout=20 -rss_limit_mb=4096
      -artifact_prefix=${CMAKE_CURRENT_BINARY_DIR}/fuzz/ ${CMAKE_CURRENT_BINARY_DIR}/fuzz/found ${fuzz_source}/seeds)
  set_tests_properties(fuzz.opendrive PROPERTIES FIXTURES_REQUIRED opendrive_fuzz)
else()
  add_test(NAME fuzz.opendrive COMMAND ${CMAKE_COMMAND} -E echo "skipped: no clang with libFuzzer and sanitizers here")
  set_tests_properties(fuzz.opendrive PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
endif()
