#include "faults.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace roevo::faults {
namespace {

using Frames = std::vector<Shown>;
using cv::Mat;

/// What is done to each frame by itself, `i` counting from the first; its images are its own to change.
using OnFrame = std::function<void(Shown&, std::size_t i, cv::RNG&)>;

Injection each(OnFrame change) {
    return [change](const Recording&, Frames& frames, std::size_t from, std::size_t to, cv::RNG& random) {
        for (std::size_t i = from; i < to; ++i) {
            RgbdFrame& frame = frames[i].frame;
            frame.grey = frame.grey.clone();
            frame.depth = frame.depth.clone();
            frames[i].faulty = true;
            change(frames[i], i - from, random);
        }
    };
}

Injection grey(std::function<void(Mat&)> change) {
    return each([change](Shown& shown, std::size_t, cv::RNG&) { change(shown.frame.grey); });
}
Injection depth(std::function<void(Mat&)> change) {
    return each([change](Shown& shown, std::size_t, cv::RNG&) { change(shown.frame.depth); });
}
Injection brightness(double gain) {
    return grey([gain](Mat& image) { image.convertTo(image, -1, gain); });
}

void saltAndPepper(Shown& shown, std::size_t, cv::RNG& random) {
    Mat noise(shown.frame.grey.size(), CV_8UC1);
    random.fill(noise, cv::RNG::UNIFORM, 0, 256);
    shown.frame.grey.setTo(0, noise < 13);
    shown.frame.grey.setTo(255, noise >= 243);
}

void noisy(Shown& shown, std::size_t, cv::RNG& random) {
    Mat noise(shown.frame.grey.size(), CV_16SC1), sum;
    random.fill(noise, cv::RNG::NORMAL, 0, 25);
    cv::add(shown.frame.grey, noise, shown.frame.grey, {}, CV_8U);
}

/// Depth left on a tenth of the image.
void cornerOnly(Mat& image) {
    const cv::Rect corner(image.cols / 12, image.rows * 5 / 8, image.cols / 3, image.rows / 3);
    const Mat kept = image(corner).clone();
    image.setTo(0);
    kept.copyTo(image(corner));
}

/// Depth missing in blocks, on 40 % of the image.
void holes(Shown& shown, std::size_t, cv::RNG& random) {
    constexpr int kBlock = 16;
    Mat& image = shown.frame.depth;
    for (int y = 0; y < image.rows; y += kBlock)
        for (int x = 0; x < image.cols; x += kBlock)
            if (random.uniform(0., 1.) < 0.4)
                image(cv::Rect(x, y, kBlock, kBlock) & cv::Rect(0, 0, image.cols, image.rows)).setTo(0);
}

void randomDepth(Shown& shown, std::size_t, cv::RNG& random) {
    random.fill(shown.frame.depth, cv::RNG::UNIFORM, 0.5, 8);
}

Mat shifted(const Mat& image, int columns) {
    Mat out = Mat::zeros(image.size(), image.type());
    image.colRange(0, image.cols - columns).copyTo(out.colRange(columns, image.cols));
    return out;
}

void coverHalf(Shown& shown, std::size_t, cv::RNG&) {
    const int half = shown.frame.grey.cols / 2;
    shown.frame.grey.colRange(0, half).setTo(90);
    shown.frame.depth.colRange(0, half).setTo(0);
}

/// A textured blob 0.35 m before the camera that moves through the image.
void hand(Shown& shown, std::size_t i, cv::RNG&) {
    Mat& image = shown.frame.grey;
    const int size = image.rows / 4;
    const int across = static_cast<int>(i) * size / 4 % (image.cols + 2 * size) - size;
    Mat shape = Mat::zeros(image.size(), CV_8UC1);
    cv::ellipse(shape, {across, image.rows * 3 / 5}, {size, size * 3 / 2}, 20, 0, 360, 255, cv::FILLED);
    image.setTo(170, shape);
    for (int finger = -2; finger <= 2; ++finger)
        cv::line(image, {across + finger * size / 3, image.rows * 2 / 5},
                 {across + finger * size / 3 + size / 8, image.rows * 3 / 5}, 110, 2);
    shown.frame.depth.setTo(0.35, shape);
}

/// A textured figure, a quarter of the image wide and nearer than most of the scene, that walks through the
/// image in five seconds, and has more contrast than many a scene.
void somebody(Shown& shown, std::size_t i, cv::RNG&) {
    Mat &image = shown.frame.grey, &depth = shown.frame.depth;
    const int width = image.cols / 4, height = image.rows * 9 / 10;
    const int left = static_cast<int>(i) * image.cols / 160 - width / 2, top = image.rows - height;
    Mat shape = Mat::zeros(image.size(), CV_8UC1), clothes(image.size(), CV_8UC1, cv::Scalar(200));
    cv::ellipse(shape, {left + width / 2, top + height * 6 / 10}, {width / 2, height * 4 / 10}, 0, 0, 360,
                255, cv::FILLED);
    cv::circle(shape, {left + width / 2, top + height / 8}, height / 8, 255, cv::FILLED);
    cv::RNG pattern(7);  // the same in every frame
    for (int k = 0; k < 40; ++k) {
        const cv::Point corner(left + pattern.uniform(0, width), top + pattern.uniform(0, height));
        const cv::Size size(pattern.uniform(4, width / 2), pattern.uniform(4, width / 2));
        cv::rectangle(clothes, {corner, size}, cv::Scalar(pattern.uniform(0, 256)), cv::FILLED);
    }
    clothes.copyTo(image, shape);
    depth.setTo(0.65 * cv::mean(depth, depth > 0)[0], shape);
}

/// As if the camera had been turned about an axis of its own, from that frame on.
Injection turn(const Eigen::Vector3d& axis, double degrees) {
    return [=](const Recording& recording, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
        const PinholeCamera& camera = recording.camera;
        const Pose T_turned_camera(Eigen::AngleAxisd(degrees * kDegree, axis));
        const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
        cv::Matx33d R;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) R(r, c) = T_turned_camera.linear()(r, c);
        for (std::size_t i = from; i < to; ++i) {
            RgbdFrame& frame = frames[i].frame;
            Mat depth(frame.depth.size(), CV_32FC1);  // along the new axis
            for (int y = 0; y < depth.rows; ++y)
                for (int x = 0; x < depth.cols; ++x) {
                    const double new_z = R(2, 0) * (x - camera.cx) / camera.fx +
                                         R(2, 1) * (y - camera.cy) / camera.fy + R(2, 2);
                    const double z = static_cast<double>(frame.depth.at<float>(y, x));
                    depth.at<float>(y, x) = static_cast<float>(std::max(0.0, z * new_z));
                }
            const Mat homography(K * R * K.inv());
            Mat image, new_depth;  // of their own: the recording's stay as they are
            cv::warpPerspective(frame.grey, image, homography, frame.grey.size(), cv::INTER_LINEAR,
                                cv::BORDER_REFLECT_101);
            cv::warpPerspective(depth, new_depth, homography, depth.size(), cv::INTER_NEAREST);
            frame.grey = image;
            frame.depth = new_depth;
            frames[i].truth = frames[i].truth * T_turned_camera.inverse();
            frames[i].faulty = true;
        }
    };
}

void torn(const Recording& recording, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
    constexpr std::size_t kBefore = 3;
    for (std::size_t i = from; i < to; ++i) {
        RgbdFrame& frame = frames[i].frame;
        const RgbdFrame& old = recording.frames[i - kBefore];
        frame.grey = frame.grey.clone();
        frame.depth = frame.depth.clone();
        const cv::Range lower(frame.grey.rows / 2, frame.grey.rows);
        old.grey.rowRange(lower).copyTo(frame.grey.rowRange(lower));
        old.depth.rowRange(lower).copyTo(frame.depth.rowRange(lower));
        frames[i].faulty = true;
    }
}

void mirrored(Shown& shown, std::size_t, cv::RNG&) {
    cv::flip(shown.frame.grey, shown.frame.grey, 1);
    cv::flip(shown.frame.depth, shown.frame.depth, 1);
}

/// @param depth_too  else the depth camera goes on
Injection frozen(bool depth_too) {
    return [=](const Recording& recording, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
        for (std::size_t i = from; i < to; ++i) {
            frames[i].frame.grey = recording.frames[from - 1].grey;
            if (depth_too) frames[i].frame.depth = recording.frames[from - 1].depth;
            frames[i].faulty = true;
        }
    };
}

void lateDepth(const Recording& recording, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
    constexpr std::size_t kLate = 5;
    for (std::size_t i = from; i < to; ++i) {
        frames[i].frame.depth = recording.frames[i - kLate].depth;
        frames[i].faulty = true;
    }
}

void dropped(const Recording&, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
    frames.erase(frames.begin() + static_cast<long>(from), frames.begin() + static_cast<long>(to));
}

void repeated(const Recording&, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
    for (std::size_t i = to; i-- > from;) {
        Shown again = frames[i];
        again.faulty = true;
        frames.insert(frames.begin() + static_cast<long>(i) + 1, again);
    }
}

/// @param stamps_too  the frames come in the wrong order; else only their images do
Injection swapped(bool stamps_too) {
    return [=](const Recording&, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
        for (std::size_t i = from; i < to && i + 1 < frames.size(); i += 2) {
            std::swap(frames[i], frames[i + 1]);
            if (!stamps_too) std::swap(frames[i].frame.timestamp, frames[i + 1].frame.timestamp);
            (stamps_too ? frames[i + 1] : frames[i]).faulty = true;
            if (!stamps_too) frames[i + 1].faulty = true;
        }
    };
}

Injection clockSetBack(double seconds) {
    return each([=](Shown& shown, std::size_t, cv::RNG&) { shown.frame.timestamp -= seconds; });
}

/// For good.
void clockSetAhead(const Recording&, Frames& frames, std::size_t from, std::size_t to, cv::RNG&) {
    for (std::size_t i = from; from < to && i < frames.size(); ++i) frames[i].frame.timestamp += 10;
}

void damagedStamp(Shown& shown, std::size_t, cv::RNG& random) {
    shown.frame.timestamp = random.uniform(-1e12, 1e12);
}

}  // namespace

const std::vector<Fault>& allFaults() {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    using E = Expected;
    static const std::vector<Fault> faults = {
        {"frames dropped", E::kTracked, dropped},
        {"frames repeated", E::kNamed, repeated},
        {"frozen", E::kNamed, frozen(true)},
        {"colour frozen", E::kNamed, frozen(false)},
        {"images swapped", E::kAny, swapped(false)},
        {"frames swapped", E::kNamed, swapped(true)},
        {"black", E::kNamed, grey([](Mat& image) { image.setTo(0); })},
        {"white", E::kNamed, grey([](Mat& image) { image.setTo(255); })},
        {"no image", E::kNamed, grey([](Mat& image) { image = Mat(); })},
        {"half the size", E::kNamed, grey([](Mat& image) { cv::resize(image, image, {}, 0.5, 0.5); })},
        {"blurred", E::kAny, grey([](Mat& image) { cv::GaussianBlur(image, image, {}, 6); })},
        {"salt and pepper", E::kAny, each(saltAndPepper)},
        {"noise of 25 grey levels", E::kAny, each(noisy)},
        {"mirrored", E::kSurvived, each(mirrored)},
        {"torn", E::kSurvived, torn},
        {"half covered", E::kAny, each(coverHalf)},
        {"a hand", E::kTracked, each(hand)},
        {"somebody walks by", E::kTracked, each(somebody)},
        {"brightness x1.5", E::kTracked, brightness(1.5)},
        {"brightness x3", E::kAny, brightness(3)},
        {"brightness x0.3", E::kTracked, brightness(0.3)},
        {"brightness x0.1", E::kAny, brightness(0.1)},
        {"depth zero", E::kTracked, depth([](Mat& image) { image.setTo(0); })},
        {"no depth", E::kTracked, depth([](Mat& image) { image = Mat(); })},
        {"depth NaN", E::kTracked, depth([=](Mat& image) { image.setTo(kNan); })},
        {"depth 2 m", E::kAny, depth([](Mat& image) { image.setTo(2); })},
        {"depth random", E::kAny, each(randomDepth)},
        {"depth x1.5", E::kAny, depth([](Mat& image) { image *= 1.5; })},
        {"depth x0.5", E::kAny, depth([](Mat& image) { image *= 0.5; })},
        {"depth shifted by 40 px", E::kAny, depth([](Mat& image) { image = shifted(image, 40); })},
        {"depth of 5 frames before", E::kAny, lateDepth},
        {"depth with holes", E::kTracked, each(holes)},
        {"depth in a corner only", E::kTracked, depth(cornerOnly)},
        {"clock set 10 s back", E::kNamed, clockSetBack(10)},
        {"clock set 10 s ahead", E::kAny, clockSetAhead},
        {"stamps damaged", E::kNamed, each(damagedStamp)},
        {"rolled by 40 deg", E::kSurvived, turn(Eigen::Vector3d::UnitZ(), 40)},
        {"turned by 40 deg", E::kSurvived, turn(Eigen::Vector3d::UnitY(), 40)},
    };
    return faults;
}

namespace {

std::vector<Shown> clean(const Recording& recording) {
    std::vector<Shown> frames;
    for (std::size_t i = 0; i < recording.frames.size(); ++i)
        frames.push_back({recording.frames[i], recording.truth[i]});
    return frames;
}

}  // namespace

std::vector<Shown> inject(const Recording& recording, const Fault& fault, std::size_t from, std::size_t count,
                          std::uint64_t seed) {
    std::vector<Shown> frames = clean(recording);
    cv::RNG random(seed);
    fault.inject(recording, frames, from, std::min(from + count, frames.size()), random);
    return frames;
}

std::vector<Shown> injectMix(const Recording& recording, std::uint64_t seed, std::string& names) {
    std::vector<Shown> frames = clean(recording);
    cv::RNG random(seed);
    (void)random.next();  // the first of small seeds are alike
    // From the end, so that what is left out or put in moves nothing that is still to come
    for (int end = static_cast<int>(recording.frames.size()) - 10; end > 20;) {
        const int count = random.uniform(1, 6);
        const auto& faults = allFaults();
        const Fault& fault =
            faults[static_cast<std::size_t>(random.uniform(0, static_cast<int>(faults.size())))];
        if (fault.expected == Expected::kSurvived) continue;
        fault.inject(recording, frames, static_cast<std::size_t>(end - count), static_cast<std::size_t>(end),
                     random);
        names = fault.name + " (" + std::to_string(count) + ")" + (names.empty() ? "" : ", ") + names;
        end -= count + random.uniform(8, 20);
    }
    return frames;
}

}  // namespace roevo::faults
