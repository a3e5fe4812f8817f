# All of the program but its command line, for the tests' sake.
add_library(roevo_compare STATIC
  compare.cpp comparison_notes.cpp core_claim.cpp core_contention.cpp given_trajectory.cpp machine_info.cpp rows.cpp run_child.cpp run_method.cpp
  run_progress.cpp sequences.cpp supervised_run.cpp terminal_table.cpp)
target_include_directories(roevo_compare PUBLIC ${PROJECT_SOURCE_DIR}/apps)
target_compile_definitions(roevo_compare PRIVATE ROEVO_BUILD_TYPE="${CMAKE_BUILD_TYPE}")
target_link_libraries(roevo_compare PUBLIC roevo_methods roevo_report roevo_recordings roevo_evaluation
                      PRIVATE roevo_mrpt roevo_programs nlohmann_json::nlohmann_json roevo_build_flags)

add_executable(roevo-compare main.cpp)
target_link_libraries(roevo-compare PRIVATE roevo_compare roevo_option_arguments roevo_programs roevo_build_flags)
install(TARGETS roevo-compare)
