add_library(roevo_simulator STATIC
  simulator/src/baked_light.cpp
  simulator/src/block_bays.cpp
  simulator/src/block_landmarks.cpp
  simulator/src/block_spot.cpp
  simulator/src/block_way.cpp
  simulator/src/camera_path.cpp
  simulator/src/intersect.cpp
  simulator/src/livingroom_furniture.cpp
  simulator/src/occlusion.cpp
  simulator/src/renderer.cpp
  simulator/src/scene_block.cpp
  simulator/src/scene_builder.cpp
  simulator/src/scene_corridor.cpp
  simulator/src/scene_livingroom.cpp
  simulator/src/scene_shadows.cpp
  simulator/src/sensor.cpp
  simulator/src/simulator.cpp
  simulator/src/surface.cpp
  simulator/src/texture.cpp
  simulator/src/texture_pictures.cpp
  simulator/src/view.cpp)
target_include_directories(roevo_simulator PUBLIC ${CMAKE_CURRENT_LIST_DIR}/simulator/include PRIVATE simulator/src)
target_link_libraries(roevo_simulator PUBLIC roevo opencv_core opencv_imgproc Threads::Threads PRIVATE roevo_build_flags)
# Lets the compiler inline square roots and floors; results stay those of IEEE arithmetic.
target_compile_options(roevo_simulator PRIVATE -fno-math-errno -fno-trapping-math)
# These only read the scene, many times per pixel: watched for races they would make every simulated test ten
# times slower. What starts threads and what they write, renderer.cpp and baked_light.cpp, stays watched.
if(ROEVO_SANITIZE MATCHES thread)
  set_source_files_properties(simulator/src/intersect.cpp simulator/src/occlusion.cpp simulator/src/surface.cpp
    simulator/src/texture.cpp simulator/src/texture_pictures.cpp simulator/src/view.cpp
    PROPERTIES COMPILE_OPTIONS -fno-sanitize=thread)
endif()

add_executable(rawlog-simulate
  rawlog-simulate/folder_layouts.cpp
  rawlog-simulate/layout.cpp
  rawlog-simulate/main.cpp
  rawlog-simulate/recording.cpp)
target_link_libraries(rawlog-simulate PRIVATE roevo_simulator roevo_datasets roevo_evaluation roevo_mrpt roevo_programs
                      opencv_imgcodecs roevo_build_flags)
target_include_directories(rawlog-simulate SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
install(TARGETS rawlog-simulate)
