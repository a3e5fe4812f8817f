#include "programs/whole_outputs.h"

#include <unistd.h>

#include <stdexcept>
#include <utility>

#include "input/regular_file.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

void check(const std::error_code& error, const fs::path& file) {
    if (error) throw std::runtime_error("cannot write " + file.string() + ": " + error.message());
}

}  // namespace

WholeOutputs::WholeOutputs(const std::string& folder, std::vector<std::string> names)
    : folder_(folder),
      temporary_(folder_ / (".partial-" + std::to_string(getpid()))),
      names_(std::move(names)) {
    checkNames();
}

WholeOutputs::~WholeOutputs() {
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);
}

void WholeOutputs::checkNames() const {
    for (const std::string& name : names_) requireReplaceable(folder_ / name);
}

std::string WholeOutputs::path(const std::string& name) {
    std::error_code error;
    fs::create_directory(temporary_, error);
    check(error, temporary_);
    written_.insert(name);
    return (temporary_ / name).string();
}

void WholeOutputs::commit() {
    checkNames();  // a run may take long
    std::error_code error;
    for (const std::string& name : names_) {
        if (written_.count(name) > 0)
            fs::rename(temporary_ / name, folder_ / name, error);
        else
            fs::remove(folder_ / name, error);
        check(error, folder_ / name);
    }
}

}  // namespace roevo
