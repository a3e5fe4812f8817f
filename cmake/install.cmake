# What `cmake --install` puts in place beside the programs: libraries, headers and a CMake package.
include(CMakePackageConfigHelpers)
install(TARGETS roevo roevo_mrpt EXPORT roevoTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/libroevo/include/roevo ${PROJECT_SOURCE_DIR}/libroevo/mrpt_module/include/roevo_mrpt
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config_ini/ DESTINATION ${CMAKE_INSTALL_DATADIR}/roevo/config_ini)
install(EXPORT roevoTargets NAMESPACE roevo:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/roevo)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/roevoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/roevoConfig.cmake ${PROJECT_BINARY_DIR}/roevoConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/roevo)
