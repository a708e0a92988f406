find_package(Python3 COMPONENTS Interpreter)
if(NOT Python3_FOUND)
  return()
endif()
# The script that measures SUMO's drivers; SUMO itself only where it is installed.
add_timed_test(counterparts.sumo_field ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/sumo_field_test.py)
set_tests_properties(counterparts.sumo_field PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)

# What the libraries of Lanelet2 and CommonRoad read in the corpus, beside what cambium reads there. They come from PyPI,
# into the build folder; where that is not to be had, the tests are skipped and say so.
left_to_all("counterparts.lanelet2, counterparts.commonroad" "install libraries of 400 MB from PyPI")
if(CAMBIUM_QUICK_TESTS OR NOT TARGET example_replay_dataset)
  return()
endif()
add_executable(counterparts_network ${CMAKE_CURRENT_LIST_DIR}/network.cpp)
target_link_libraries(counterparts_network PRIVATE cambium_test_options)
foreach(name lanelet2 commonroad)
  add_program_test(counterparts.${name} counterparts_network ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/check.py
    ${name} ${CMAKE_CURRENT_BINARY_DIR}/counterparts_${name} $<TARGET_FILE:counterparts_network>
    $<TARGET_FILE:example_replay_dataset>)
  set_tests_properties(counterparts.${name} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
endforeach()
add_dependencies(counterparts_network example_replay_dataset)
