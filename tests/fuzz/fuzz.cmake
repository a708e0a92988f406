# The fuzzers of the readers of maps, where there is a clang with its fuzzing and sanitizer libraries. Targets outside
# `all`; their ctests build them and run them for a short while, with a fixed seed. Elsewhere the tests are skipped.
left_to_all("fuzz.*" "need a build with sanitizers; here damaged files in map")
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

# add_fuzzer(NAME MAX_LENGTH): of NAME_fuzz.cpp, from the texts in NAME_seeds.
function(add_fuzzer name max_length)
  if(NOT (CAMBIUM_FUZZING_CLANG AND CAMBIUM_FUZZ_PUGIXML))
    add_test(NAME fuzz.${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: no clang with libFuzzer and sanitizers here")
    set_tests_properties(fuzz.${name} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
    return()
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/fuzz)
  set(fuzzer ${folder}/${name}_fuzz)
  file(MAKE_DIRECTORY ${folder}/${name}_found)  # what is new goes there
  # Another compiler than the project's, perhaps: so a command instead of a target of the project's own.
  add_custom_command(OUTPUT ${fuzzer}
    COMMAND ${CAMBIUM_FUZZING_CLANG} ${fuzz_flags} @${compile_flags} ${CAMBIUM_WARNINGS} -Werror -MMD -MT ${fuzzer}
      -MF ${fuzzer}.d ${fuzz_source}/${name}_fuzz.cpp ${CAMBIUM_FUZZ_PUGIXML} -o ${fuzzer}
    DEPENDS ${fuzz_source}/${name}_fuzz.cpp ${compile_flags} DEPFILE ${fuzzer}.d
    COMMENT "${name}_fuzz" VERBATIM)
  add_custom_target(${name}_fuzz DEPENDS ${fuzzer})
  add_build_test(fuzz.${name}.build ${name}_fuzz)
  set_tests_properties(fuzz.${name}.build PROPERTIES FIXTURES_SETUP ${name}_fuzz)
  add_timed_test(fuzz.${name} ${fuzzer} -max_len=${max_length} -seed=1 -runs=4000 -max_total_time=30 -timeout=20
      -rss_limit_mb=4096 -artifact_prefix=${folder}/ ${folder}/${name}_found ${fuzz_source}/${name}_seeds)
  set_tests_properties(fuzz.${name} PROPERTIES FIXTURES_REQUIRED ${name}_fuzz)
endfunction()
add_fuzzer(opendrive 6000)
add_fuzzer(lanelet 12000)
