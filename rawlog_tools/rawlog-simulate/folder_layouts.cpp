// Folders as the benchmarks pack them.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "layout.h"
#include "programs/text.h"
#include "programs/whole_folder.h"
#include "recording.h"
#include "recordings/camera_file.h"
#include "roevo_mrpt/image_conversions.h"

namespace roevo {
namespace {

using simulator::SimulatedFrame;

std::string cameraText(const PinholeCamera& camera) {
    return cameraFileText(camera, 5000, {"invalid_depth: 0", "note: simulated"}, allDigits);
}

const std::string& withParents(const std::string& path) {
    std::error_code ignored;  // WholeFolder says what is wrong
    std::filesystem::create_directories(std::filesystem::path(path).lexically_normal().parent_path(),
                                        ignored);
    return path;
}

class FolderRecording : public Recording {
  public:
    explicit FolderRecording(const std::string& path) : folder_(withParents(path)) {}
    void finish() final {
        finishFiles();
        folder_.commit();
    }

  protected:
    /// Writes what comes after the last frame, such as lists.
    virtual void finishFiles() {}
    void writePng(const std::string& name, const cv::Mat& image) const {
        writeImageFile((folder_ / name).string(), image, {cv::IMWRITE_PNG_COMPRESSION, 1});
    }

    WholeFolder folder_;
};

/// rgb/ and depth/ with one name per frame, and the lists that go with them.
class PairsRecording : public FolderRecording {
  public:
    explicit PairsRecording(const std::string& path) : FolderRecording(path) {
        folder_.makeFolder("rgb");
        folder_.makeFolder("depth");
    }
    void add(const SimulatedFrame& frame) override {
        addPair(frame, stampText(frame.timestamp), stampText(frame.timestamp));
        truth_ += truthLine(frame.timestamp, frame.T_world_camera);
    }

  protected:
    /// @param stamp  what the lists say of the time, @param name  of both files, without ending
    void addPair(const SimulatedFrame& frame, const std::string& stamp, const std::string& name) {
        const std::string rgb = "rgb/" + name + ".png", depth = "depth/" + name + ".png";
        writePng(rgb, frame.colour);
        writePng(depth, simulator::quantiseDepth(frame.depth_noisy));
        rgb_ += stamp + " " + rgb + "\n";
        depth_ += stamp + " " + depth + "\n";
        rgb_first_ += stamp + " " + rgb + " " + stamp + " " + depth + "\n";
        depth_first_ += stamp + " " + depth + " " + stamp + " " + rgb + "\n";
    }

    std::string rgb_ = "# timestamp filename\n", depth_ = rgb_;
    std::string rgb_first_, depth_first_;
    std::string truth_ = kTruthHeader;
};

class TumRecording : public PairsRecording {
  public:
    TumRecording(const std::string& path, const PinholeCamera& camera) : PairsRecording(path) {
        folder_.write("camera.txt", cameraText(camera));
    }

  private:
    void finishFiles() override {
        folder_.write("rgb.txt", rgb_);
        folder_.write("depth.txt", depth_);
        folder_.write("associations.txt", rgb_first_);
        folder_.write("groundtruth.txt", truth_);
    }
};

class PlainRecording : public PairsRecording {
  public:
    PlainRecording(const std::string& path, const PinholeCamera& camera) : PairsRecording(path) {
        folder_.write("camera.txt", cameraText(camera));
    }
    void add(const SimulatedFrame& frame) override {
        addPair(frame, "", stampText(frame.timestamp));
        truth_ += truthLine(frame.timestamp, frame.T_world_camera);
    }

  private:
    void finishFiles() override { folder_.write("groundtruth.txt", truth_); }
};

class Eth3dRecording : public PairsRecording {
  public:
    Eth3dRecording(const std::string& path, const PinholeCamera& camera) : PairsRecording(path) {
        folder_.write("calibration.txt", allDigits(camera.fx) + " " + allDigits(camera.fy) + " " +
                                             allDigits(camera.cx) + " " + allDigits(camera.cy) + "\n");
    }

  private:
    void finishFiles() override {
        folder_.write("rgb.txt", rgb_);
        folder_.write("depth.txt", depth_);
        folder_.write("associated.txt", rgb_first_);
        folder_.write("groundtruth.txt", truth_);
    }
};

/// The frame's pose in ICL-NUIM's left-handed world, whose camera has y up: y of the position changes its
/// sign, and so do turns about the other two axes.
std::string leftHandedTruthLine(long number, const Pose& T_world_camera) {
    const Eigen::Vector3d t = T_world_camera.translation();
    const Eigen::Quaterniond q(T_world_camera.linear());
    char text[256];
    std::snprintf(text, sizeof text, "%ld %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", number, t.x(), -t.y(),
                  t.z(), -q.x(), q.y(), -q.z(), q.w());
    return text;
}

class IclRecording : public PairsRecording {
  public:
    IclRecording(const std::string& path, const PinholeCamera& camera) : PairsRecording(path) {
        // The dataset itself has no calibration file: everybody knows its one camera
        if (camera != iclCamera(camera.width, camera.height) || camera.width != 640 || camera.height != 480)
            folder_.write("camera.txt", cameraText(camera));
        truth_.clear();
    }
    void add(const SimulatedFrame& frame) override {
        const std::string number = std::to_string(frameNumber(frame.timestamp));
        addPair(frame, number, number);
        truth_ += leftHandedTruthLine(frameNumber(frame.timestamp), frame.T_world_camera);
    }

  private:
    void finishFiles() override {
        folder_.write("associations.txt", depth_first_);
        folder_.write("traj0.gt.freiburg", truth_);
    }
};

class SevenScenesRecording : public FolderRecording {
  public:
    SevenScenesRecording(const std::string& path, const Pose& T_colour_depth)
        : FolderRecording(path), T_colour_depth_(T_colour_depth) {}

    void add(const SimulatedFrame& frame) override {
        char name[32];
        std::snprintf(name, sizeof name, "frame-%06ld", frameNumber(frame.timestamp));
        writePng(std::string(name) + ".color.png", frame.colour);
        writePng(std::string(name) + ".depth.png", millimetres(frame.depth_noisy));
        const Eigen::Matrix4d pose = (frame.T_world_camera * T_colour_depth_).matrix();
        std::string text;
        for (int row = 0; row < 4; ++row) {
            char line[128];
            std::snprintf(line, sizeof line, "%.12e\t%.12e\t%.12e\t%.12e\t\n", pose(row, 0), pose(row, 1),
                          pose(row, 2), pose(row, 3));
            text += line;
        }
        folder_.write(std::string(name) + ".pose.txt", text);
    }

  private:
    static cv::Mat millimetres(const cv::Mat& metres) {
        constexpr uint16_t kUnknown = 65535;
        cv::Mat result(metres.size(), CV_16UC1);
        for (int row = 0; row < metres.rows; ++row)
            for (int col = 0; col < metres.cols; ++col) {
                const double units = std::round(1000. * static_cast<double>(metres.at<float>(row, col)));
                result.at<uint16_t>(row, col) =
                    units > 0 && units < kUnknown ? static_cast<uint16_t>(units) : kUnknown;
            }
        return result;
    }

    Pose T_colour_depth_;
};

}  // namespace

std::unique_ptr<Recording> recordFolder(const std::string& layout, const std::string& path,
                                        const simulator::SimulationOptions& options,
                                        const PinholeCamera& camera) {
    if (layout == "icl") return std::make_unique<IclRecording>(path, camera);
    if (layout == "eth3d") return std::make_unique<Eth3dRecording>(path, camera);
    if (layout == "plain") return std::make_unique<PlainRecording>(path, camera);
    if (layout == "7scenes")
        return std::make_unique<SevenScenesRecording>(path, options.depth_sensor.value().T_colour_depth);
    return std::make_unique<TumRecording>(path, camera);
}

}  // namespace roevo
