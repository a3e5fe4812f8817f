#pragma once
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "mrpt/test_helpers.h"

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

namespace roevo::test {

/// A small dataset on disk in any folder layout: 64x48 pixels, everything two metres away, frames 100, 101 …
/// at 30 Hz, a ground truth that moves along x by 1 cm per frame.
class SmallDataset {
  public:
    explicit SmallDataset(const std::string& layout, int count = 3, const std::string& name = "dataset")
        : layout_(layout), path_(folder_.path() / name) {
        std::filesystem::create_directories(path_ / "rgb");
        std::filesystem::create_directories(path_ / "depth");
        const bool frames = layout == "7scenes";
        if (frames)
            for (const char* unused : {"rgb", "depth"}) std::filesystem::remove(path_ / unused);
        std::string rgb, depth, pairs, truth;
        for (int i = 0; i < count; i++) {
            writeColour(i, cv::Mat(48, 64, CV_8UC3, cv::Scalar(10 * i, 50, 90)));
            writeDepth(i, cv::Mat(48, 64, CV_16UC1, cv::Scalar(2 * unitsPerMetre())));
            rgb += stamp(i) + " " + colour(i) + "\n";
            depth += stamp(i) + " " + this->depth(i) + "\n";
            pairs += stamp(i) + " " + this->depth(i) + " " + stamp(i) + " " + colour(i) + "\n";
            truth += stamp(i) + " " + std::to_string(0.01 * i) + " 0 0 0 0 0 1\n";
            if (frames) write(pose(i), "1 0 0 " + std::to_string(0.01 * i) + "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
        }
        if (layout == "tum" || layout == "eth3d") {
            write("rgb.txt", rgb);
            write("depth.txt", depth);
        }
        if (layout == "eth3d") write("associated.txt", pairs);
        if (layout == "icl") write("associations.txt", pairs);
        if (!frames) write(truthFile(), truth);
        if (layout == "eth3d")
            write("calibration.txt", "60 61 31.5 23.5\n");
        else
            writeCamera(std::to_string(unitsPerMetre()));
    }

    void writeCamera(const std::string& depth_scale, const std::string& more = "") const {
        write("camera.txt", "width: 64\nheight: 48\nfx: 60\nfy: 61\ncx: 31.5\ncy: 23.5\ndepth_scale: " +
                                depth_scale + "\n" + more);
    }
    void write(const std::string& name, const std::string& text) const { writeFile(path_ / name, text); }
    std::string read(const std::string& name) const { return readFile(path_ / name); }
    void remove(const std::string& name) const { std::filesystem::remove_all(path_ / name); }
    void writeColour(int i, const cv::Mat& image) const { cv::imwrite((path_ / colour(i)).string(), image); }
    void writeDepth(int i, const cv::Mat& image) const { cv::imwrite((path_ / depth(i)).string(), image); }

    int unitsPerMetre() const { return layout_ == "7scenes" ? 1000 : 5000; }
    /// Text files that say which images there are.
    std::vector<std::string> lists() const {
        if (layout_ == "tum") return {"rgb.txt", "depth.txt"};
        if (layout_ == "eth3d") return {"associated.txt"};
        if (layout_ == "icl") return {"associations.txt"};
        return {};
    }
    std::string truthFile() const { return layout_ == "icl" ? "traj0.gt.freiburg" : "groundtruth.txt"; }
    static double time(int i) { return std::stod(seconds(i)); }
    std::string stamp(int i) const { return layout_ == "icl" ? std::to_string(100 + i) : seconds(i); }
    std::string colour(int i) const { return image("rgb/", ".color", i); }
    std::string depth(int i) const { return image("depth/", ".depth", i); }
    static std::string pose(int i) { return "frame-000" + std::to_string(100 + i) + ".pose.txt"; }

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::string path() const { return path_.string(); }
    const TemporaryFolder& parent() const { return folder_; }

  private:
    static std::string seconds(int i) { return std::to_string((100 + i) / 30.0); }
    std::string image(const std::string& folder, const std::string& kind, int i) const {
        if (layout_ == "7scenes") return "frame-000" + std::to_string(100 + i) + kind + ".png";
        return folder + stamp(i) + ".png";
    }

    TemporaryFolder folder_;
    std::string layout_;
    std::filesystem::path path_;
};

}  // namespace roevo::test
