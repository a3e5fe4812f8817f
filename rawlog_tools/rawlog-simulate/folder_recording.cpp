#include "folder_recording.h"

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "roevo_mrpt/image_conversions.h"

namespace roevo {

namespace fs = std::filesystem;

FolderRecording::FolderRecording(const std::string& path) : path_(path) {
    std::error_code ignored;
    if (fs::exists(path_, ignored) && !fs::is_empty(path_, ignored))
        throw std::runtime_error(path + ": exists already; remove it or choose another --output");
    while (path_.has_relative_path() && path_.filename().empty()) path_ = path_.parent_path();
    partial_ = path_.string() + ".part";
    std::error_code error;
    fs::remove_all(partial_, error);
    fs::create_directories(partial_, error);
    if (error) throw std::runtime_error(path + ": cannot be created: " + error.message());
}

FolderRecording::~FolderRecording() {
    std::error_code ignored;
    if (!finished_) fs::remove_all(partial_, ignored);
}

void FolderRecording::finish() {
    finishFiles();
    std::error_code error;
    if (fs::exists(path_)) fs::remove(path_, error);  // an empty folder
    fs::rename(partial_, path_, error);
    if (error) throw std::runtime_error(path_.string() + ": cannot be put in place: " + error.message());
    finished_ = true;
}

void FolderRecording::makeFolder(const std::string& name) const {
    std::error_code error;
    fs::create_directories(partial_ / name, error);
    if (error)
        throw std::runtime_error((partial_ / name).string() + ": cannot be created: " + error.message());
}

void FolderRecording::writeText(const std::string& name, const std::string& text) const {
    std::ofstream file(partial_ / name, std::ios::binary);
    file << text << std::flush;
    if (!file)
        throw std::runtime_error((partial_ / name).string() + ": cannot be written; is the disk full?");
}

void FolderRecording::writePng(const std::string& name, const cv::Mat& image) const {
    writeImageFile((partial_ / name).string(), image, {cv::IMWRITE_PNG_COMPRESSION, 1});
}

}  // namespace roevo
