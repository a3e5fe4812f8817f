roevo_test(test_includes SOURCES includes/test_includes.cpp LIBS Threads::Threads)
target_include_directories(test_includes PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
