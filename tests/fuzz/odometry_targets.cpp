// The odometry: maps that it is to begin with, and frames.
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "core/support/simulated.h"
#include "fuzz/promises.h"
#include "input/byte_stream.h"
#include "roevo/odometry.h"

namespace roevo::fuzz {
namespace {

constexpr char kMagic[] = "ROEVOMAP";
constexpr std::size_t kHead = 8 + 4 + 8 + 8;  ///< bytes of a map file before its contents

void requireHonest(const FrameResult& result) {
    require(result.status == FrameStatus::kOk || !result.reason.empty(), "a status without a reason");
    requireRigid(result.T_world_camera);
    require(result.covariance.allFinite() && result.covariance.diagonal().minCoeff() >= 0,
            "a covariance is none");
}

void requireHonest(const Odometry& odometry) {
    double last = -INFINITY;
    for (const StampedPose& pose : odometry.trajectory()) {
        requireRigid(pose.T_world_camera);
        require(pose.timestamp > last, "stamps do not ascend");
        last = pose.timestamp;
    }
    for (const MapEdge& edge : odometry.map())
        for (const auto& point : edge.points) require(point.allFinite(), "a point of the map is none");
}

/// The same few frames of a small room for all maps.
const testing::Sequence& room() {
    static const testing::Sequence sequence = [] {
        simulator::SimulationOptions options;
        options.width = 120;
        options.height = 90;
        options.speed = 1;
        return testing::simulate(options, 5);
    }();
    return sequence;
}

OdometryOptions mapping() {
    OdometryOptions options;
    options.keyframe.max_translation = 0.05;
    return options;
}

/// The contents of a map file with the checksum (FNV-1a) that belongs to them.
std::string sealed(std::string_view contents) {
    std::uint64_t sum = 0xCBF29CE484222325U, size = contents.size();
    for (const char byte : contents) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001B3U;
    std::uint32_t version = 1;
    ByteWriter head;
    head(version, size, sum);
    return kMagic + head.bytes() + std::string(contents);
}

/// Reads a stream of small decisions; zeros after its end.
class Choices {
  public:
    explicit Choices(std::string_view bytes) : left_(bytes) {}
    bool any() const { return !left_.empty(); }
    unsigned next(unsigned count) {
        if (left_.empty()) return 0;
        const auto byte = static_cast<unsigned char>(left_[0]);
        left_.remove_prefix(1);
        return byte % count;
    }
    /// Mostly one that makes sense.
    double number(double usual) {
        const double odd[] = {0,       -usual, 1e-9, 1e9, 1e300, std::numeric_limits<double>::quiet_NaN(),
                              INFINITY};
        const unsigned choice = next(64);
        return choice < std::size(odd) ? odd[choice] : usual * (0.5 + choice / 64.0);
    }

  private:
    std::string_view left_;
};

cv::Mat grey(Choices& choices, const cv::Size& size, int frame) {
    const int types[] = {CV_8UC1, CV_8UC1, CV_8UC1, CV_8UC3, CV_16UC1, CV_32FC1, CV_8SC1};
    const cv::Size sizes[] = {size,
                              size,
                              size,
                              size,
                              {size.width / 2, size.height / 2},
                              {1, 1},
                              {0, 0},
                              {size.width + 1, size.height}};
    cv::Mat image = cv::Mat::zeros(sizes[choices.next(8)], types[choices.next(7)]);
    cv::RNG random(choices.next(256) + 1);
    switch (choices.next(4)) {
        case 0:
            if (!image.empty()) random.fill(image, cv::RNG::UNIFORM, 0, 256);
            break;
        case 1:
            image.setTo(choices.next(256));
            break;
        default:  // boxes that move by a pixel or so from frame to frame
            for (int i = 0; i < 12 && image.cols > 8 && image.rows > 8; i++) {
                const cv::Point corner(random.uniform(0, image.cols), random.uniform(0, image.rows));
                const cv::Point shift(frame * random.uniform(0, 3), 0);
                const cv::Size box(random.uniform(4, image.cols / 2), random.uniform(4, image.rows / 2));
                image(cv::Rect(corner + shift, box) & cv::Rect({}, image.size()))
                    .setTo(random.uniform(0, 256));
            }
    }
    return image;
}

cv::Mat depth(Choices& choices, const cv::Size& size) {
    const int types[] = {CV_32FC1, CV_32FC1, CV_32FC1, CV_32FC1, CV_16UC1, CV_64FC1};
    const cv::Size sizes[] = {size, size, size, size, size, {size.height, size.width}, {1, 1}, {0, 0}};
    cv::Mat image(sizes[choices.next(8)], types[choices.next(6)], cv::Scalar(1.5));
    cv::RNG random(choices.next(256) + 1);
    const double odd[] = {0, -1, 1e-30, 1e30, NAN, INFINITY, 2, 0.3};
    switch (choices.next(4)) {
        case 0:
            if (!image.empty()) random.fill(image, cv::RNG::UNIFORM, 0, 8);
            break;
        case 1:
            image.setTo(odd[choices.next(8)]);
            break;
        case 2:
            if (image.cols > 1) image.colRange(0, image.cols / 2).setTo(odd[choices.next(8)]);
            break;
        default:
            break;
    }
    return image;
}

}  // namespace

/// The first byte says whether a checksum is made: no fuzzer would find one.
void runMap(std::string_view bytes) {
    if (bytes.empty()) return;
    const bool seal = bytes[0] != '\0';
    bytes.remove_prefix(1);
    std::istringstream in(seal ? sealed(bytes) : std::string(bytes));
    Odometry odometry(room().camera, mapping());
    accepted([&] { odometry.loadMap(in); });
    for (const RgbdFrame& frame : room().frames) requireHonest(odometry.processFrame(frame));
    (void)odometry.refineAll();
    requireHonest(odometry);
    std::ostringstream out;
    accepted([&] { odometry.saveMap(out); });
}

std::vector<std::string> mapSeeds() {
    Odometry odometry(room().camera, mapping());
    for (const RgbdFrame& frame : room().frames) (void)odometry.processFrame(frame);
    std::ostringstream out;
    odometry.saveMap(out);
    return {'\1' + out.str().substr(kHead), '\0' + out.str()};
}

void runFrames(std::string_view bytes) {
    Choices choices(bytes);
    PinholeCamera camera;
    camera.width = 64 + static_cast<int>(choices.next(64));
    camera.height = 48 + static_cast<int>(choices.next(64));
    camera.fx = choices.number(80), camera.fy = choices.number(80);
    camera.cx = choices.number(camera.width / 2.), camera.cy = choices.number(camera.height / 2.);
    if (choices.next(4) == 3)
        for (double& k : camera.distortion) k = choices.number(0.1);
    OdometryOptions options;
    options.mode = static_cast<Mode>(choices.next(3));
    std::unique_ptr<Odometry> odometry;
    try {
        odometry = std::make_unique<Odometry>(camera, options);
    } catch (const std::invalid_argument&) {
        return;
    }
    const cv::Size size(camera.width, camera.height);
    const double steps[] = {1 / 30., 1 / 30., 1 / 30., 0, -1, 1, 100, -1e4, NAN, 1e300};
    double timestamp = 1000;
    for (int i = 0; i < 12 && choices.any(); i++) {
        timestamp += steps[choices.next(10)];
        RgbdFrame frame{timestamp, grey(choices, size, i), depth(choices, size), {}};
        if (choices.next(8) == 7) cv::flip(frame.grey, frame.grey, 1);
        if (choices.next(4) == 3) frame.colour = cv::Mat(frame.grey.size(), CV_8UC3, cv::Scalar(1, 2, 3));
        if (choices.next(16) == 15) frame.colour = frame.depth;
        requireHonest(odometry->processFrame(frame));
        if (!std::isfinite(timestamp)) timestamp = 1000 + i;
    }
    (void)odometry->refineAll();
    requireHonest(*odometry);
}

std::vector<std::string> framesSeeds() {
    // Usual cameras; frames that are all usual, and some that are not
    std::string usual("\x20\x20\x20\x20\x20\x20\0\2", 8), odd = usual;
    for (int i = 0; i < 8; i++) {
        usual += std::string("\1\0\0\7\2\0\0\5\3\0\0\0", 12);
        odd += std::string("\1\0\0\7\2\0\0\5\3\0\0\0", 12);
        odd[odd.size() - static_cast<std::size_t>(i) - 1] = static_cast<char>(37 * i + 5);
    }
    return {usual, odd};
}

}  // namespace roevo::fuzz
