#pragma once
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "recording.h"

namespace roevo {

/// What recordings into a folder have in common: everything goes into <folder>.part, which gets its name when
/// whole.
class FolderRecording : public Recording {
  public:
    /// @param path  must not exist yet, or be empty. @throws std::runtime_error when it cannot be written
    explicit FolderRecording(const std::string& path);
    ~FolderRecording() override;

    void finish() final;

  protected:
    /// Writes what comes after the last frame, such as lists.
    virtual void finishFiles() {}

    void makeFolder(const std::string& name) const;
    void writeText(const std::string& name, const std::string& text) const;
    void writePng(const std::string& name, const cv::Mat& image) const;

  private:
    std::filesystem::path path_, partial_;
    bool finished_ = false;
};

/// Recordings into a folder: "tum", "icl", "eth3d", "7scenes" or "plain".
std::unique_ptr<Recording> recordFolder(const std::string& layout, const std::string& path,
                                        const simulator::SimulationOptions& options,
                                        const PinholeCamera& camera);

}  // namespace roevo
