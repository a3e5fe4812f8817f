# Micro-benchmarks. Not tests: their figures depend on the machine, so nothing here can fail.
find_package(benchmark REQUIRED)
add_executable(bench_core bench/bench_edges.cpp bench/bench_clips.cpp bench/bench_kernels.cpp bench/bench_odometry.cpp
               bench/room.cpp)
target_link_libraries(bench_core PRIVATE roevo_internal roevo_simulator opencv_imgcodecs benchmark::benchmark_main
                      roevo_build_flags)
target_include_directories(bench_core PRIVATE ${CMAKE_CURRENT_LIST_DIR} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
target_compile_definitions(bench_core PRIVATE ROEVO_DATA_DIR="${ROEVO_DATA_DIR}")
