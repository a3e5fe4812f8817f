roevo_test(test_simulator
  SOURCES tools/test_simulator.cpp tools/test_simulator_paths.cpp tools/test_simulator_sensor.cpp
  LIBS roevo_simulator)
roevo_test(test_simulator_program SOURCES tools/test_simulator_program.cpp LIBS roevo_simulator)
add_dependencies(test_simulator_program rawlog-simulate)
