# All of the program but its command line, for the tests' sake.
add_library(roevo_compare STATIC
  benchmark_list.cpp compare.cpp comparison_notes.cpp core_contention.cpp kept_run.cpp machine_info.cpp method_run.cpp
  queue_display.cpp run_child.cpp run_method.cpp run_progress.cpp run_queue.cpp runs.cpp sequences.cpp
  terminal_table.cpp)
target_include_directories(roevo_compare PUBLIC ${PROJECT_SOURCE_DIR}/apps)
target_compile_definitions(roevo_compare PRIVATE ROEVO_BUILD_TYPE="${CMAKE_BUILD_TYPE}")
target_link_libraries(roevo_compare PUBLIC roevo_methods roevo_report roevo_recordings roevo_evaluation
                      PRIVATE roevo_mrpt roevo_programs nlohmann_json::nlohmann_json roevo_build_flags)

add_executable(roevo-compare main.cpp)
target_link_libraries(roevo-compare PRIVATE roevo_compare roevo_option_arguments roevo_programs roevo_build_flags)
install(TARGETS roevo-compare)
