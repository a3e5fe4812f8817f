add_library(roevo_test_support STATIC support/tum_folder.cpp)
target_include_directories(roevo_test_support PUBLIC ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PUBLIC ${OpenCV_INCLUDE_DIRS})
target_link_libraries(roevo_test_support PUBLIC opencv_core opencv_imgproc opencv_imgcodecs PRIVATE roevo_build_flags)

roevo_test(test_evaluation
  SOURCES apps/test_trajectory_io.cpp apps/test_evaluation.cpp apps/test_nees.cpp apps/test_support.cpp apps/test_ahead.cpp
          apps/test_run_report.cpp apps/test_eval_alignments.cpp apps/test_trajectory_formats.cpp apps/test_eval_page.cpp
          ${PROJECT_SOURCE_DIR}/apps/roevo-odometry/run_report.cpp
  LIBS roevo_internal roevo_evaluation roevo_programs roevo_test_support nlohmann_json::nlohmann_json)
add_dependencies(test_evaluation roevo-eval)

target_include_directories(test_evaluation PRIVATE ${PROJECT_SOURCE_DIR}/apps)

roevo_test(test_programs
  SOURCES apps/test_every_program.cpp apps/test_eval_program.cpp apps/test_render_pictures.cpp apps/test_render_program.cpp
          apps/test_odometry_program.cpp apps/test_masks_program.cpp apps/test_bad_folders.cpp apps/test_bad_rawlogs.cpp apps/test_realtime.cpp
          apps/test_odd_rawlogs_program.cpp apps/test_scale_check.cpp apps/test_special_files.cpp
          apps/test_shown_text.cpp apps/test_limits.cpp apps/test_mrpt_outputs.cpp apps/test_threads.cpp
  LIBS roevo_test_support roevo_evaluation roevo_recordings roevo_mrpt roevo_internal nlohmann_json::nlohmann_json opencv_videoio SUITES)
add_dependencies(test_programs roevo-odometry roevo-eval roevo-render rgbd2rawlog rawlog2rgbd rawlog-simulate
                 roevo-study)
roevo_test(test_render_page
  SOURCES apps/test_render_page.cpp apps/test_render_browser.cpp
  LIBS roevo_test_support roevo_evaluation roevo_programs roevo_mrpt roevo_internal nlohmann_json::nlohmann_json SUITES)
add_dependencies(test_render_page roevo-render)
roevo_test(test_map_program
  SOURCES apps/test_map_program.cpp apps/test_same_bytes.cpp
  LIBS roevo_test_support roevo_evaluation nlohmann_json::nlohmann_json SUITES)
add_dependencies(test_map_program roevo-odometry rawlog-simulate)

# Needs the whole build. Sanitized libraries would want the sanitizer in the program that uses them, too.
if(NOT ROEVO_SANITIZE)
  add_test(NAME Install.LibrariesCanBeFoundAndUsed
           COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DWORK=${CMAKE_BINARY_DIR}/install_test
                   -DLAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER} -P ${CMAKE_CURRENT_SOURCE_DIR}/apps/install_test.cmake)
  set_tests_properties(Install.LibrariesCanBeFoundAndUsed PROPERTIES TIMEOUT ${ROEVO_TEST_TIMEOUT})
  if(NOT TARGET roevo_python)
    set_tests_properties(Install.LibrariesCanBeFoundAndUsed PROPERTIES ENVIRONMENT WITHOUT_PYTHON=1)
  endif()
endif()

roevo_test(test_distance_field
  SOURCES apps/test_distance_field.cpp
  LIBS roevo_methods roevo_simulator roevo_evaluation SUITES)
target_include_directories(test_distance_field PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})

roevo_test(test_study_ablation
  SOURCES apps/test_study_ablation.cpp apps/test_study_efficiency.cpp apps/test_study_points.cpp
          apps/test_study_viewpoint.cpp apps/test_study_ways.cpp apps/test_study_loop.cpp apps/test_study_gaps.cpp apps/test_study_growth.cpp
  LIBS roevo_study roevo_simulator roevo_test_support SUITES)
target_include_directories(test_study_ablation PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})

roevo_test(test_compare
  SOURCES apps/test_method_run.cpp apps/test_rows.cpp apps/test_process.cpp apps/test_supervised_run.cpp
          apps/test_compare_sequences.cpp apps/test_compare_program.cpp apps/test_compare_terminal.cpp
          apps/test_compare_ba_first.cpp apps/test_compare_trajectories.cpp apps/test_compare_browser.cpp
          apps/test_compare_mixed.cpp
  LIBS roevo_compare roevo_programs roevo_test_support nlohmann_json::nlohmann_json SUITES)
add_dependencies(test_compare roevo-compare roevo-odometry roevo-render rgbd2rawlog rawlog-simulate)

roevo_test(test_batch
  SOURCES apps/test_batch.cpp apps/test_batch_slurm.cpp
  LIBS roevo_compare roevo_programs roevo_test_support nlohmann_json::nlohmann_json SUITES)
add_dependencies(test_batch roevo-compare roevo-odometry)

# One ctest entry per method, since its cases share rendered frames.
add_executable(test_compare_baselines apps/test_compare_baselines.cpp apps/test_depth_resampler.cpp support/main.cpp)
target_link_libraries(test_compare_baselines PRIVATE roevo_methods roevo_simulator roevo_evaluation GTest::gtest
                      roevo_build_flags)
foreach(suite DepthResampler.* CentredCamera.* BaselineList.* Difodo480.* */difodo_240 */icp_frame */icp_keyframe
        */opencv_rgbd */opencv_rgbd_icp)
  string(REGEX REPLACE "[.*/]" "" case ${suite})
  add_test(NAME CompareBaselines.${case} COMMAND test_compare_baselines --gtest_filter=${suite})
  set_tests_properties(CompareBaselines.${case} PROPERTIES TIMEOUT ${ROEVO_TEST_TIMEOUT} SKIP_RETURN_CODE 77)
endforeach()
target_include_directories(test_compare_baselines PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})

roevo_test(test_compare_report
  SOURCES apps/test_compare_tables.cpp apps/test_compare_report.cpp apps/test_compare_many.cpp
          apps/test_compare_numpy.cpp apps/test_compare_plots.cpp
  LIBS roevo_report roevo_evaluation roevo_programs roevo_test_support nlohmann_json::nlohmann_json SUITES)
add_dependencies(test_compare_report roevo-compare roevo-odometry roevo-render)

roevo_test(test_study
  SOURCES apps/test_study_program.cpp apps/test_study_repeatability.cpp apps/test_gnuplot.cpp
  LIBS roevo_study roevo_test_support SUITES)
target_include_directories(test_study SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_dependencies(test_study roevo-study)
