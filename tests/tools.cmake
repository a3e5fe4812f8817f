roevo_test(test_tools
  SOURCES tools/test_tum.cpp tools/test_tum_association.cpp tools/test_depth_scale.cpp tools/test_camera_file.cpp
  LIBS roevo_datasets roevo_recordings roevo_evaluation roevo_programs)
target_include_directories(test_tools PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
add_dependencies(test_tools rgbd2rawlog)
roevo_test(test_rawlog_tools
  SOURCES tools/test_rgbd2rawlog.cpp tools/test_rgbd2rawlog_options.cpp tools/test_verify.cpp tools/test_rawlog2rgbd.cpp
          tools/test_rawlog2rgbd_errors.cpp tools/test_mrpt_apps.cpp tools/test_permissions.cpp tools/test_full_disk.cpp tools/test_depth_times.cpp tools/test_round_trip.cpp
  LIBS roevo_rgbd2rawlog roevo_datasets roevo_mrpt roevo_evaluation SUITES)
target_include_directories(test_rawlog_tools PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_include_directories(test_rawlog_tools SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_dependencies(test_rawlog_tools rgbd2rawlog rawlog2rgbd rawlog-simulate)
include(${CMAKE_CURRENT_LIST_DIR}/simulator.cmake OPTIONAL)
roevo_test(test_ros_bags SOURCES tools/test_ros_bags.cpp tools/test_ros_messages.cpp tools/test_ros_bags_bad_input.cpp
           LIBS roevo_datasets roevo_mrpt SQLite::SQLite3 BZip2::BZip2 PkgConfig::LZ4 PkgConfig::ZSTD ZLIB::ZLIB SUITES)
target_include_directories(test_ros_bags PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_dependencies(test_ros_bags rawlog-simulate rgbd2rawlog bag2rawlog roevo-odometry roevo-compare roevo-study)
include(${CMAKE_CURRENT_LIST_DIR}/rosbag.cmake)
if(TARGET roevo_rosbag)
  roevo_test(test_bag SOURCES tools/test_bag.cpp tools/test_bag_errors.cpp LIBS roevo_datasets roevo_mrpt roevo_rosbag SUITES)
  target_include_directories(test_bag PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_include_directories(test_bag SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
  add_dependencies(test_bag bag2rawlog)
endif()
roevo_test(test_datasets_readme SOURCES tools/test_datasets_readme.cpp LIBS roevo_datasets roevo_mrpt nlohmann_json::nlohmann_json SUITES)
target_include_directories(test_datasets_readme PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_include_directories(test_datasets_readme SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_dependencies(test_datasets_readme rgbd2rawlog bag2rawlog roevo-odometry roevo-eval roevo-compare)
roevo_test(test_inputs SOURCES tools/test_inputs.cpp tools/test_inputs_bad.cpp tools/test_image_times.cpp tools/test_calibration_file.cpp tools/folder_kinds.cpp tools/folder_writer.cpp
           LIBS roevo_datasets roevo_mrpt roevo_programs SUITES)
target_include_directories(test_inputs PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_dependencies(test_inputs rawlog-simulate rgbd2rawlog rawlog2rgbd roevo-odometry)
