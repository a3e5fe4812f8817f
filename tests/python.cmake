# The Python module by unittest, in Debian's own Python.
if(TARGET roevo_python)
  foreach(script roevo roevo_values)
    add_test(NAME Python.${script} COMMAND ${Python_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/python/test_${script}.py)
    set_tests_properties(Python.${script} PROPERTIES TIMEOUT ${ROEVO_TEST_TIMEOUT} ENVIRONMENT
      "PYTHONPATH=$<TARGET_FILE_DIR:roevo_python>;ROEVO_BIN_DIR=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  endforeach()
endif()
