# The Python module by unittest, in Debian's own Python.
if(TARGET roevo_python)
  add_test(NAME Python.Module COMMAND ${Python_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/python/test_roevo.py)
  set_tests_properties(Python.Module PROPERTIES TIMEOUT ${ROEVO_TEST_TIMEOUT} ENVIRONMENT
    "PYTHONPATH=$<TARGET_FILE_DIR:roevo_python>;ROEVO_BIN_DIR=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
endif()
