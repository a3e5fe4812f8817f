// Writes what a fuzzer begins with: fuzz_seeds FOLDER, one folder for each target in it.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fuzz/targets.h"

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "Usage: fuzz_seeds FOLDER\n"), 2;
    for (const roevo::fuzz::Target& target : roevo::fuzz::targets()) {
        const std::filesystem::path folder = std::filesystem::path(argv[1]) / target.name;
        std::filesystem::create_directories(folder);
        int count = 0;
        for (const std::string& seed : target.seeds())
            std::ofstream(folder / std::to_string(count++), std::ios::binary) << seed;
        std::printf("%s: %d seeds\n", folder.c_str(), count);
    }
    return 0;
}
