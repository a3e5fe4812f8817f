#include "programs/output_folder.h"

#include <filesystem>
#include <stdexcept>

#include "programs/atomic_file.h"
#include "programs/program.h"

namespace roevo {

namespace fs = std::filesystem;

void prepareOutputFolder(const std::string& folder) {
    std::error_code error;
    std::vector<std::string> missing;  // the innermost first
    for (fs::path path = fs::path(folder).lexically_normal(); !path.empty() && !fs::exists(path, error);
         path = path.parent_path())
        missing.push_back(path.string());
    fs::create_directories(folder, error);
    for (const std::string& made : missing) removeIfLeftEmpty(made);
    if (error || !fs::is_directory(folder))
        throw std::runtime_error("cannot create the output folder " + folder + ": " +
                                 (error ? error.message() : "a file of that name is in the way"));
    AtomicFile probe((fs::path(folder) / ".roevo-probe").string());
    probe.stream();
}

bool isWithin(const std::string& file, const std::string& folder) {
    const fs::path from_there = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
    return !from_there.empty() && *from_there.begin() != "..";
}

bool isSameFile(const std::string& a, const std::string& b) {
    return !a.empty() && !b.empty() && fs::weakly_canonical(a) == fs::weakly_canonical(b);
}

void keepInputs(const char* option, const std::string& output, const std::vector<std::string>& inputs) {
    if (output.empty()) return;
    std::error_code none;
    const bool exists = fs::exists(output, none);
    for (const std::string& input : inputs) {
        if (input.empty()) continue;
        const fs::path path(input), images = path.parent_path() / (path.stem().string() + "_Images");
        const bool among_files = exists && ((fs::is_directory(path, none) && isWithin(output, input)) ||
                                            (path.extension() == ".rawlog" && isWithin(output, images)));
        if (among_files || isSameFile(output, input))
            throw UsageError(std::string(option) + " " + output + " is an input; give another name");
    }
}

}  // namespace roevo
