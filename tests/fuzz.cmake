# What takes bytes from outside. The targets run on their seeds with every suite; with ROEVO_FUZZ (preset fuzz,
# clang) each is a program of libFuzzer as well: fuzz_NAME CORPUS, begun with what fuzz_seeds FOLDER writes.
add_library(roevo_fuzz_targets STATIC fuzz/targets.cpp fuzz/text_targets.cpp fuzz/recording_targets.cpp
            fuzz/odometry_targets.cpp fuzz/input_targets.cpp tools/folder_kinds.cpp tools/folder_writer.cpp)
target_link_libraries(roevo_fuzz_targets PUBLIC roevo_internal roevo_datasets roevo_mrpt roevo_evaluation roevo_simulator roevo_programs
                      GTest::gtest SQLite::SQLite3 BZip2::BZip2 PkgConfig::LZ4 PkgConfig::ZSTD ZLIB::ZLIB
                      PRIVATE roevo_build_flags)
target_include_directories(roevo_fuzz_targets PUBLIC ${CMAKE_CURRENT_SOURCE_DIR} SYSTEM PUBLIC ${OpenCV_INCLUDE_DIRS})
target_compile_definitions(roevo_fuzz_targets PRIVATE ROEVO_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
roevo_test(test_fuzz SOURCES fuzz/test_fuzz.cpp LIBS roevo_fuzz_targets SUITES)

if(ROEVO_FUZZ)
  add_executable(fuzz_seeds fuzz/write_seeds.cpp)
  target_link_libraries(fuzz_seeds PRIVATE roevo_fuzz_targets roevo_build_flags)
  foreach(target dataset_folder camera_file calibration_file array other_folder options trajectory rawlog bag map frames)
    add_executable(fuzz_${target} fuzz/libfuzzer.cpp)
    target_compile_definitions(fuzz_${target} PRIVATE ROEVO_FUZZ_TARGET="${target}")
    target_link_libraries(fuzz_${target} PRIVATE roevo_fuzz_targets roevo_build_flags)
    target_link_options(fuzz_${target} PRIVATE -fsanitize=fuzzer)
  endforeach()
endif()
