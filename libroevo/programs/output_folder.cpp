#include "programs/output_folder.h"

#include <filesystem>
#include <stdexcept>

#include "programs/atomic_file.h"

namespace roevo {

void prepareOutputFolder(const std::string& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder))
        throw std::runtime_error("cannot create the output folder " + folder + ": " +
                                 (error ? error.message() : "a file of that name is in the way"));
    AtomicFile probe((fs::path(folder) / ".roevo-probe").string());
    probe.stream();
}

}  // namespace roevo
