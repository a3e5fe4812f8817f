#include "programs/whole_folder.h"

#include <fstream>
#include <stdexcept>

namespace roevo {

namespace fs = std::filesystem;

namespace {

void require(const std::error_code& error, const std::string& what) {
    if (error) throw std::runtime_error("cannot " + what + ": " + error.message());
}

}  // namespace

WholeFolder::WholeFolder(const std::string& folder) : folder_(fs::path(folder).lexically_normal()) {
    if (!folder_.has_filename()) folder_ = folder_.parent_path();  // "out/"
    std::error_code fault;
    const bool is_folder = fs::is_directory(folder_, fault);
    const bool is_empty = is_folder && fs::is_empty(folder_, fault);
    if (fault != std::errc::no_such_file_or_directory) require(fault, "write " + folder);
    if (is_folder ? !is_empty : fs::exists(folder_, fault))
        throw std::runtime_error("cannot write " + folder + ": it exists" +
                                 (is_folder ? " and is not empty" : "") +
                                 "; choose another output folder or move it away");
    temporary_ = folder_.string() + ".part";
    std::error_code ignored, error;
    fs::remove_all(temporary_, ignored);  // of a run that was killed
    fs::create_directory(temporary_, error);
    require(error, "create the folder " + folder);
}

WholeFolder::~WholeFolder() {
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);
}

void WholeFolder::makeFolder(const std::string& name) const {
    std::error_code error;
    fs::create_directory(temporary_ / name, error);
    require(error, "create the folder " + (temporary_ / name).string());
}

void WholeFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream file(temporary_ / name, std::ios::binary);
    file << text << std::flush;
    if (!file)
        throw std::runtime_error("cannot write " + (temporary_ / name).string() + "; is the disk full?");
}

void WholeFolder::commit() {
    std::error_code ignored, error;
    fs::remove(folder_, ignored);  // an empty one
    fs::rename(temporary_, folder_, error);
    require(error, "write " + folder_.string());
}

}  // namespace roevo
