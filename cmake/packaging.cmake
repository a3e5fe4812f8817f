# Debian packages by `cpack` in the build folder (scripts/make_packages.sh): libroevo-dev, roevo-tools, python3-roevo.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME roevo)
set(CPACK_PACKAGE_CONTACT "ROEVO's maintainers <roevo@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL dev tools)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libroevo-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEV_DESCRIPTION "RGB-D visual odometry from organized edges, library
 Static libraries, headers and a CMake package with three components: core, which needs
 what this package depends on, mrpt and recordings, which need what it recommends.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libopencv-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS
    "libmrpt-dev, zlib1g-dev, libjpeg-dev, libbz2-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, libyaml-cpp-dev, pkg-config")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME roevo-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "RGB-D visual odometry from organized edges, programs
 roevo-odometry makes a trajectory and a map of edges of a depth camera's recording;
 others draw, measure and compare them, and convert and simulate recordings.")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS gnuplot-nox)

if(TARGET roevo_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-roevo)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "RGB-D visual odometry from organized edges, Python module
 Images go in as numpy arrays; poses, covariances and the map come out as such.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-pil)
endif()

foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES LICENSE DESTINATION ${documents} RENAME copyright COMPONENT ${component})
endforeach()
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libroevo-dev COMPONENT dev PATTERN "*.py" EXCLUDE)
if(TARGET roevo_python)
  install(FILES examples/recording.py DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-roevo/examples COMPONENT python)
endif()
include(CPack)
