# Every method under comparison. One set of files each, listed here and in methods/registry.cpp.
add_library(roevo_methods STATIC
  methods/registry.cpp
  methods/roevo_method.cpp
  methods/distance_field_method.cpp
  methods/distance_field.cpp)
target_include_directories(roevo_methods PUBLIC ${PROJECT_SOURCE_DIR}/apps ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(roevo_methods PUBLIC roevo PRIVATE roevo_mrpt roevo_build_flags)
