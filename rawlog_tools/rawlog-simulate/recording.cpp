#include "recording.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "roevo_mrpt/rawlog_writer.h"
#include "support/atomic_file.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using simulator::SimulatedFrame;

std::string stampText(double timestamp) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6f", timestamp);
    return text;
}

std::string truthLine(const SimulatedFrame& frame) {
    const Eigen::Vector3d t = frame.T_world_camera.translation();
    Eigen::Quaterniond q(frame.T_world_camera.linear());
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    char text[256];
    std::snprintf(text, sizeof text, "%.6f %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", frame.timestamp, t.x(),
                  t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
    return text;
}

constexpr char kTruthHeader[] = "# timestamp tx ty tz qx qy qz qw\n";

class RawlogRecording : public Recording {
  public:
    RawlogRecording(const std::string& path, const PinholeCamera& camera)
        : writer_(path, camera),
          truth_((fs::path(path).parent_path() / (fs::path(path).stem().string() + "_groundtruth.txt"))
                     .string()) {
        truth_.stream() << kTruthHeader;
    }
    void add(const SimulatedFrame& frame) override {
        writer_.add(frame.timestamp, simulator::quantiseDepth(frame.depth_noisy), frame.colour);
        truth_.stream() << truthLine(frame);
    }
    void finish() override {
        writer_.finish();
        truth_.commit();
    }

  private:
    RawlogWriter writer_;
    AtomicFile truth_;
};

class TumRecording : public Recording {
  public:
    TumRecording(const std::string& path, const PinholeCamera& camera) : path_(path) {
        std::error_code ignored;
        if (fs::exists(path_, ignored) && !fs::is_empty(path_, ignored))
            throw std::runtime_error(path + ": exists already; remove it or choose another --output");
        while (path_.has_relative_path() && path_.filename().empty()) path_ = path_.parent_path();
        partial_ = path_.string() + ".part";
        std::error_code error;
        fs::remove_all(partial_, error);
        fs::create_directories(partial_ / "rgb", error);
        if (!error) fs::create_directories(partial_ / "depth", error);
        if (error) throw std::runtime_error(path + ": cannot be created: " + error.message());
        writeText("camera.txt", cameraText(camera));
        rgb_ = "# timestamp filename\n";
        depth_ = rgb_;
        truth_ = kTruthHeader;
    }
    ~TumRecording() override {
        std::error_code ignored;
        if (!finished_) fs::remove_all(partial_, ignored);
    }
    void add(const SimulatedFrame& frame) override {
        const std::string stamp = stampText(frame.timestamp);
        const std::string rgb = stamp + " rgb/" + stamp + ".png", depth = stamp + " depth/" + stamp + ".png";
        writePng("rgb/" + stamp + ".png", frame.colour);
        writePng("depth/" + stamp + ".png", simulator::quantiseDepth(frame.depth_noisy));
        rgb_ += rgb + "\n";
        depth_ += depth + "\n";
        pairs_ += rgb + " " + depth + "\n";
        truth_ += truthLine(frame);
    }
    void finish() override {
        writeText("rgb.txt", rgb_);
        writeText("depth.txt", depth_);
        writeText("associations.txt", pairs_);
        writeText("groundtruth.txt", truth_);
        std::error_code error;
        if (fs::exists(path_)) fs::remove(path_, error);  // an empty folder
        fs::rename(partial_, path_, error);
        if (error) throw std::runtime_error(path_.string() + ": cannot be put in place: " + error.message());
        finished_ = true;
    }

  private:
    static std::string cameraText(const PinholeCamera& camera) {
        char text[512];
        const auto& k = camera.distortion;
        std::snprintf(
            text, sizeof text,
            "width: %d\nheight: %d\nfx: %.17g\nfy: %.17g\ncx: %.17g\ncy: %.17g\n"
            "distortion_k1_k2_p1_p2_k3: %.17g %.17g %.17g %.17g %.17g\n"
            "depth_scale: 5000   # PNG value / depth_scale = metres\ninvalid_depth: 0\nnote: simulated\n",
            camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, k[0], k[1], k[2], k[3],
            k[4]);
        return text;
    }
    void writeText(const std::string& name, const std::string& text) const {
        std::ofstream file(partial_ / name, std::ios::binary);
        file << text << std::flush;
        if (!file)
            throw std::runtime_error((partial_ / name).string() + ": cannot be written; is the disk full?");
    }
    void writePng(const std::string& name, const cv::Mat& image) const {
        if (!cv::imwrite((partial_ / name).string(), image, {cv::IMWRITE_PNG_COMPRESSION, 1}))
            throw std::runtime_error((partial_ / name).string() + ": cannot be written; is the disk full?");
    }

    fs::path path_, partial_;
    std::string rgb_, depth_, pairs_, truth_;
    bool finished_ = false;
};

}  // namespace

std::unique_ptr<Recording> recordRawlog(const std::string& path, const PinholeCamera& camera) {
    return std::make_unique<RawlogRecording>(path, camera);
}

std::unique_ptr<Recording> recordTumFolder(const std::string& path, const PinholeCamera& camera) {
    return std::make_unique<TumRecording>(path, camera);
}

}  // namespace roevo
