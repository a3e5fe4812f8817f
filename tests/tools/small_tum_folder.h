#pragma once
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "mrpt/test_helpers.h"

namespace roevo::test {

inline constexpr double kTumStart = 1305031453.359684;

/// A small TUM sequence on disk: `count` frames at 10 Hz, depth 4 ms later, everything two metres away.
class SmallTumFolder {
  public:
    explicit SmallTumFolder(int count = 3, int depth_value = 10000) {
        std::filesystem::create_directories(folder_ / "rgb");
        std::filesystem::create_directories(folder_ / "depth");
        std::string rgb = "# color images\n# timestamp filename\n", depth = "# depth maps\n";
        for (int i = 0; i < count; i++) {
            rgb += stamp(i) + " " + rgbName(i) + "\n";
            depth += stamp(i, 0.004) + " " + depthName(i) + "\n";
            cv::imwrite(folder_ / rgbName(i), cv::Mat(48, 64, CV_8UC3, cv::Scalar(10 * i, 50, 90)));
            cv::Mat image(48, 64, CV_16UC1, cv::Scalar(depth_value));
            image.at<std::uint16_t>(i, 2) = 0;
            cv::imwrite(folder_ / depthName(i), image);
        }
        write("rgb.txt", rgb);
        write("depth.txt", depth);
        writeCamera("5000");
    }

    void writeCamera(const std::string& depth_scale) {
        write("camera.txt",
              "width: 64\nheight: 48\nfx: 60\nfy: 61\ncx: 31.5\ncy: 23.5\n"
              "distortion_k1_k2_p1_p2_k3: 0.1 -0.2 0.001 0.002 0.3\ndepth_scale: " +
                  depth_scale + "   # PNG value / depth_scale = metres\nlicence: none: really\n");
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    void remove(const std::string& name) const { std::filesystem::remove(folder_ / name); }

    static std::string stamp(int i, double offset = 0) {
        return std::to_string(kTumStart + 0.1 * i + offset);
    }
    static std::string rgbName(int i) { return "rgb/" + stamp(i) + ".png"; }
    static std::string depthName(int i) { return "depth/" + stamp(i, 0.004) + ".png"; }

    std::string operator/(const std::string& name) const { return folder_ / name; }
    std::string path() const { return folder_.path().string(); }

  private:
    TemporaryFolder folder_;
};

}  // namespace roevo::test
