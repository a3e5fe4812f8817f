roevo_test(test_mrpt
  SOURCES mrpt/test_config_file.cpp mrpt/test_profiles.cpp mrpt/test_conversions.cpp mrpt/test_image_files.cpp
          mrpt/test_file_copy.cpp mrpt/test_observation_converter.cpp mrpt/test_rawlog.cpp mrpt/test_odd_rawlogs.cpp
          mrpt/test_foreign_rawlogs.cpp
          mrpt/test_roevo_odometry.cpp mrpt/test_roevo_odometry_maps.cpp mrpt/test_scene_builder.cpp
  LIBS roevo_mrpt roevo_recordings roevo_programs SUITES)
target_include_directories(test_mrpt PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
