#include "roevo_mrpt/map_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "input/regular_file.h"
#include "whole_file.h"

namespace roevo {

int loadMapFile(const std::string& file, Odometry& odometry, MapUse use) {
    requireRegularInput(file);
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + file + ": " + std::strerror(errno));
    try {
        return odometry.loadMap(in, use);
    } catch (const std::runtime_error& fault) {
        throw std::runtime_error(file + ": " + fault.what());
    }
}

int saveMapFile(const Odometry& odometry, const std::string& file) {
    int keyframes = 0;
    writeWholeFile(file, [&](const std::string& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        if (!out) return false;
        keyframes = odometry.saveMap(out);
        out.close();
        return !out.fail();
    });
    return keyframes;
}

}  // namespace roevo
