roevo_test(test_simulator
  SOURCES tools/test_simulator.cpp tools/test_simulator_block.cpp tools/test_simulator_paths.cpp
          tools/test_simulator_sensor.cpp
  LIBS roevo_simulator)
roevo_test(test_simulator_program SOURCES tools/test_simulator_program.cpp LIBS roevo_simulator SUITES)
add_dependencies(test_simulator_program rawlog-simulate)
roevo_test(test_layouts
  SOURCES tools/test_layouts_bad_input.cpp tools/test_eth3d.cpp tools/test_plain_folder.cpp
          tools/test_misread_folders.cpp tools/test_icl.cpp
          tools/test_seven_scenes.cpp tools/test_same_frames.cpp
  LIBS roevo_datasets roevo_mrpt roevo_evaluation roevo_simulator SUITES)
target_include_directories(test_layouts PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
add_dependencies(test_layouts rawlog-simulate rgbd2rawlog roevo-odometry)
