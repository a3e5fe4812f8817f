# Faults injected between recordings and the odometry; ROEVO_FAULT_TABLE=FILE makes it write the table of docs/reliability.md.
roevo_test(test_faults
  SOURCES faults/faults.cpp faults/judge.cpp faults/test_faults.cpp
  LIBS roevo_internal roevo_simulator roevo_evaluation roevo_datasets)
target_include_directories(test_faults PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_include_directories(test_faults SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
