# Faults injected between recordings and the odometry, in one ctest entry: the cases share a rendered sequence.
# FaultTable is not run: ROEVO_FAULT_TABLE=FILE makes the program write the table of docs/reliability.md.
add_executable(test_faults faults/faults.cpp faults/judge.cpp faults/test_faults.cpp support/main.cpp)
target_link_libraries(test_faults PRIVATE roevo_internal roevo_simulator roevo_evaluation roevo_datasets GTest::gtest roevo_build_flags)
target_compile_definitions(test_faults PRIVATE ROEVO_DATA_DIR="${ROEVO_DATA_DIR}")
target_include_directories(test_faults PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_include_directories(test_faults SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_test(NAME Faults COMMAND test_faults --gtest_filter=-FaultTable.*)
set_tests_properties(Faults PROPERTIES TIMEOUT ${ROEVO_TEST_TIMEOUT} SKIP_RETURN_CODE 77)
