roevo_test(test_core_camera
  SOURCES core/test_pinhole_camera.cpp core/test_undistorter.cpp core/test_depth_registration.cpp
  LIBS roevo_internal opencv_calib3d)
roevo_test(test_core_edges
  SOURCES core/test_pixel_kernels.cpp core/test_edge_kernels.cpp core/test_gradient.cpp core/test_canny.cpp core/test_adjacency.cpp core/test_organize.cpp
          core/test_organize_trees.cpp core/test_normals.cpp core/test_edge_grid.cpp core/test_edge_depth.cpp
          core/test_edge_sides.cpp
  LIBS roevo_internal)
roevo_test(test_core_tracking
  SOURCES core/test_kernels.cpp core/test_residual_kernels.cpp core/test_photometric.cpp core/test_fine_jacobians.cpp core/test_gauss_newton.cpp
          core/test_se3.cpp core/test_motion_model.cpp core/test_row_motion.cpp core/test_edge_association.cpp core/test_rolling_shutter.cpp core/test_motion_blur.cpp core/test_edge_points.cpp core/test_options.cpp
          core/test_relative_pose.cpp core/test_edge_clusters.cpp core/test_map_refusal.cpp core/test_robust.cpp
  LIBS roevo_internal)
# Ceres solves the bundle adjustment once more, as an independent oracle.
find_package(Ceres REQUIRED)
roevo_test(test_core_mapping
  SOURCES core/test_covisibility.cpp core/test_semi_dense.cpp
          core/test_edge_smoothing.cpp core/test_edge_fusion.cpp core/test_bundle_adjustment.cpp core/test_bundle_ceres.cpp core/test_pseudo_edges.cpp
          core/test_local_mapper.cpp core/test_packed_keyframe.cpp core/test_pose_graph.cpp
          core/test_window_posterior.cpp core/test_refine_all.cpp core/test_map_culling.cpp
  LIBS roevo_internal Ceres::ceres)
roevo_test(test_core_odometry
  SOURCES core/test_trajectory.cpp core/test_trajectory_joins.cpp core/test_motion_smoother.cpp core/test_keyframe_maker.cpp core/test_fine_tracker.cpp
          core/test_odometry_accuracy.cpp core/test_odometry_status.cpp core/test_frame_depth.cpp core/test_masks.cpp core/test_prepared_frames.cpp
          core/test_odometry_covariance.cpp core/test_odometry_semi_dense.cpp core/test_tracker_overrides.cpp
  LIBS roevo_internal roevo_simulator roevo_evaluation SUITES)
roevo_test(test_core_mapped_runs
  SOURCES core/test_odometry_mapping.cpp core/test_mapping_bad_input.cpp core/test_mapping_gauge.cpp core/test_mapping_reuse.cpp core/test_learned_readout.cpp core/test_former_references.cpp
          core/test_relocalisation.cpp core/test_loop_closing.cpp core/test_kidnapping.cpp core/test_lack_of_resources.cpp
  LIBS roevo_internal roevo_simulator roevo_evaluation SUITES)
roevo_test(test_core_map_file SOURCES core/test_map_file.cpp core/test_map_growth.cpp LIBS roevo_internal roevo_simulator roevo_evaluation SUITES)
# In four entries, since they take long
add_executable(test_option_extremes core/test_option_extremes.cpp support/main.cpp)
target_link_libraries(test_option_extremes PRIVATE roevo_internal roevo_datasets roevo_evaluation GTest::gtest roevo_build_flags)
target_compile_definitions(test_option_extremes PRIVATE ROEVO_DATA_DIR="${ROEVO_DATA_DIR}")
target_include_directories(test_option_extremes PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
foreach(shard RANGE 3)
  add_test(NAME OptionExtremes.${shard} COMMAND test_option_extremes)
  set_tests_properties(OptionExtremes.${shard} PROPERTIES TIMEOUT ${ROEVO_TEST_TIMEOUT} SKIP_RETURN_CODE 77
                       ENVIRONMENT "GTEST_TOTAL_SHARDS=4;GTEST_SHARD_INDEX=${shard}")
endforeach()
roevo_test(test_core_sequences
  SOURCES core/test_simulated_sequences.cpp core/test_real_clips.cpp core/test_wide_baseline.cpp core/test_shadow_edges.cpp
  LIBS roevo_internal roevo_simulator roevo_evaluation roevo_datasets SUITES)
roevo_test(test_core_place
  SOURCES core/test_place_describer.cpp core/test_place_matches.cpp core/test_place_index.cpp core/test_place_verifier.cpp
          core/test_place_registration.cpp core/test_place_clips.cpp
  LIBS roevo_internal roevo_simulator roevo_evaluation roevo_datasets SUITES)
foreach(program camera edges tracking place mapping odometry mapped_runs map_file sequences)
  target_include_directories(test_core_${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_include_directories(test_core_${program} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
endforeach()
