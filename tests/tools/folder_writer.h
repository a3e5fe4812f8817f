#pragma once
/// What the kinds of folders of folder_kinds.h are written with.

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "recordings/dataset_reader.h"

namespace roevo::test {

using Arguments = std::vector<std::string>;

/// A folder that is written from another recording.
class FolderWriter {
  public:
    FolderWriter(const DatasetReader& from, const std::filesystem::path& to);

    std::size_t size() const { return from_.size(); }
    double time(std::size_t i) const { return from_.entry(i).timestamp; }
    long number(std::size_t i) const;  ///< at 30 Hz
    const PinholeCamera& camera() const { return from_.camera(); }
    const GroundTruth& truth() const { return from_.groundTruth(); }
    cv::Mat colour(std::size_t i) const { return from_.readImage(i); }
    cv::Mat depth(std::size_t i) const { return from_.readDepth(i); }  ///< 5000 per metre
    cv::Mat metres(std::size_t i) const { return from_.toFrameDepth(depth(i)); }
    cv::Mat millimetres(std::size_t i) const;

    void image(const std::string& name, const cv::Mat& image) const;
    void text(const std::string& name, const std::string& text) const;
    void cameraFile(const std::string& more = "frame_rate: 30\n") const;
    void copyTruth() const;

    /// All images under names that follow from the frame.
    using Name = std::function<std::string(std::size_t)>;
    void images(const Name& colour_name, const Name& depth_name) const;

  private:
    const DatasetReader& from_;
    std::filesystem::path to_;
};

std::string format(const char* pattern, double value);
std::string format(const char* pattern, long value);
/// @param pattern  for width, height, fx, fy, cx, cy
std::string format(const char* pattern, const PinholeCamera& camera);

/// Every second pixel of every second row.
cv::Mat halved(const cv::Mat& image);

Arguments writeScanNet(const DatasetReader& from, const std::filesystem::path& to);
Arguments writeStray(const DatasetReader& from, const std::filesystem::path& to);
Arguments writeRecord3d(const DatasetReader& from, const std::filesystem::path& to);

/// Depth as numpy's arrays. @param depth_type  of OpenCV. @param type  of numpy
Arguments writeArrays(const DatasetReader& from, const std::filesystem::path& to, int depth_type,
                      const char* type);

/// What a camera with a lens would have seen: bilinear, depth of the nearest pixel; black where the ideal
/// image ends.
Arguments writeThroughLens(const DatasetReader& from, const std::filesystem::path& to,
                           const PinholeCamera& lens);

}  // namespace roevo::test
