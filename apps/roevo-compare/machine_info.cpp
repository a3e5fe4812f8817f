#include "machine_info.h"

#include <mrpt/system/os.h>

#include <Eigen/Core>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <opencv2/core/version.hpp>

#include "programs/process.h"
#include "programs/program.h"

namespace roevo {
namespace {

constexpr char kPlain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";

// What follows the key in the first line of the file that begins with it; empty when there is none.
std::string valueInFile(const char* file, const std::string& key, const char* leading) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.compare(0, key.size(), key) != 0) continue;
        const std::size_t begin = line.find_first_not_of(leading, key.size());
        return begin == std::string::npos ? std::string() : line.substr(begin);
    }
    return {};
}

std::string compilerName() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unknown";
#endif
}

std::string processorName() {
    std::string name = valueInFile("/proc/cpuinfo", "model name", " \t:");
    if (name.empty()) name = valueInFile("/proc/cpuinfo", "Model", " \t:");  // ARM boards
    return name.empty() ? "unknown processor" : name;
}

}  // namespace

std::string machineText() {
    const std::size_t cores = allowedCores().size();
    std::string text = processorName() + ", " + std::to_string(cores) + (cores == 1 ? " core" : " cores");
    if (const std::string memory = valueInFile("/proc/meminfo", "MemTotal", " \t:"); !memory.empty()) {
        char size[32];
        std::snprintf(size, sizeof size, ", %.1f GB", std::stod(memory) * 1024 / 1e9);  // "16384000 kB"
        text += size;
    }
    std::string system = valueInFile("/etc/os-release", "PRETTY_NAME", "=\"");
    if (!system.empty() && system.back() == '"') system.pop_back();
    return text + ", " + (system.empty() ? "unknown system" : system);
}

std::vector<std::pair<std::string, std::string>> softwareVersions() {
    std::string mrpt = mrpt::system::MRPT_getVersion();  // "MRPT 2.5.8"
    mrpt.erase(0, mrpt.find_first_of("0123456789"));
    const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." +
                              std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION);
    return {{"ROEVO", versionText()},
            {"MRPT", mrpt},
            {"OpenCV", CV_VERSION},
            {"Eigen", eigen},
            {"compiler", compilerName() + ", " ROEVO_BUILD_TYPE}};
}

std::string shellCommand(const std::vector<std::string>& words) {
    std::string command;
    for (const std::string& word : words) {
        if (!command.empty()) command += ' ';
        if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
            command += word;
            continue;
        }
        command += '\'';
        for (const char c : word) command += c == '\'' ? std::string("'\\''") : std::string(1, c);
        command += '\'';
    }
    return command;
}

std::string utcNow() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

}  // namespace roevo
