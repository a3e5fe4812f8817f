# What `cmake --install` puts in place beside the programs: libraries, headers and a CMake package of three components,
# core, mrpt and recordings, each with what it needs alone.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/roevo)
set(core roevo)
set(mrpt roevo_mrpt)
set(recordings roevo_recordings roevo_datasets roevo_evaluation roevo_programs)
foreach(component core mrpt recordings)
  set_target_properties(${${component}} PROPERTIES POSITION_INDEPENDENT_CODE ON)  # for users' plugins
  install(TARGETS ${${component}} EXPORT roevo_${component} COMPONENT dev)
  install(EXPORT roevo_${component} FILE roevo_${component}.cmake NAMESPACE roevo:: DESTINATION ${package} COMPONENT dev)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/libroevo/include/roevo ${PROJECT_SOURCE_DIR}/libroevo/mrpt_module/include/roevo_mrpt
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config_ini/ DESTINATION ${CMAKE_INSTALL_DATADIR}/roevo/config_ini COMPONENT tools)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/roevoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/roevoConfig.cmake ${PROJECT_BINARY_DIR}/roevoConfigVersion.cmake
        DESTINATION ${package} COMPONENT dev)
