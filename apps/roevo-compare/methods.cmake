# Every method under comparison. One set of files each, listed here and in methods/registry.cpp.
add_library(roevo_methods STATIC
  methods/registry.cpp
  methods/roevo_method.cpp
  methods/distance_field_method.cpp
  methods/distance_field.cpp
  methods/registration_method.cpp
  methods/depth_resampler.cpp
  methods/difodo.cpp
  methods/icp.cpp
  methods/opencv_rgbd.cpp)
target_include_directories(roevo_methods PUBLIC ${PROJECT_SOURCE_DIR}/apps ${CMAKE_CURRENT_SOURCE_DIR})
# Baselines share parts of the core: how frames are checked, the tracker, the motion model.
target_link_libraries(roevo_methods PUBLIC roevo_internal
                      PRIVATE roevo_evaluation roevo_mrpt roevo_programs nlohmann_json::nlohmann_json roevo_build_flags)

# Baselines of libraries that need not be there: without its library a method is known, and says why it cannot be run.
find_package(mrpt-vision QUIET)
find_package(mrpt-slam QUIET)
if(mrpt-vision_FOUND)
  target_compile_definitions(roevo_methods PRIVATE ROEVO_HAVE_MRPT_VISION)
  target_link_libraries(roevo_methods PRIVATE mrpt::vision)
endif()
if(mrpt-slam_FOUND)
  target_compile_definitions(roevo_methods PRIVATE ROEVO_HAVE_MRPT_SLAM)
  target_link_libraries(roevo_methods PRIVATE mrpt::slam)
endif()
if(TARGET opencv_rgbd)
  target_compile_definitions(roevo_methods PRIVATE ROEVO_HAVE_OPENCV_RGBD)
  target_link_libraries(roevo_methods PRIVATE opencv_rgbd)
endif()
