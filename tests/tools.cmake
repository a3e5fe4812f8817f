roevo_test(test_tools
  SOURCES tools/test_rgbd2rawlog.cpp tools/test_tum.cpp tools/test_tum_association.cpp
  LIBS roevo_datasets)
target_include_directories(test_tools PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
add_dependencies(test_tools rgbd2rawlog)
include(${CMAKE_CURRENT_LIST_DIR}/simulator.cmake OPTIONAL)
