#include "programs/memory_peak.h"

#include <fstream>
#include <string>

namespace roevo {

double memoryPeakMb() {
    // Not getrusage(): its figure can be that of the process that started this one.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024 / 1e6;
    }
    return 0;
}

}  // namespace roevo
