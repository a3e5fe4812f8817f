#include "programs/output_folder.h"

#include <filesystem>
#include <stdexcept>

#include "programs/atomic_file.h"
#include "programs/program.h"

namespace roevo {

namespace fs = std::filesystem;

void prepareOutputFolder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder))
        throw std::runtime_error("cannot create the output folder " + folder + ": " +
                                 (error ? error.message() : "a file of that name is in the way"));
    AtomicFile probe((fs::path(folder) / ".roevo-probe").string());
    probe.stream();
}

void keepInputs(const char* option, const std::string& output, const std::vector<std::string>& inputs) {
    if (output.empty()) return;
    const fs::path file = fs::weakly_canonical(output);
    const auto isIn = [&](const fs::path& folder) {
        std::error_code none;
        const fs::path from_there = file.lexically_relative(fs::weakly_canonical(folder));
        return fs::is_directory(folder, none) && fs::exists(file, none) && !from_there.empty() &&
               *from_there.begin() != "..";
    };
    for (const std::string& input : inputs) {
        if (input.empty()) continue;
        const fs::path path(input), images = path.parent_path() / (path.stem().string() + "_Images");
        if (file == fs::weakly_canonical(path) || isIn(path) ||
            (path.extension() == ".rawlog" && isIn(images)))
            throw UsageError(std::string(option) + " " + output + " is an input; give another name");
    }
}

}  // namespace roevo
