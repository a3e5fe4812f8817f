#include "recordings/time_units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "evaluation/association.h"
#include "evaluation/trajectory_io.h"
#include "programs/text.h"
#include "recordings/image_lists.h"
#include "roevo_mrpt/time_conversions.h"
#include "tracking/robust.h"

namespace roevo {
namespace {

constexpr double kYear2000 = 9.5e8, kYear2100 = 4.1e9;    // s
constexpr double kShortestStep = 2e-4, kLongestStep = 5;  // s; ms at 200 Hz are 5 apart
constexpr double kMostlyShared = 0.5;

/// Times of frames or poses, in some unit.
struct Span {
    double first, last, step;

    explicit Span(const std::vector<double>& ascending)
        : first(ascending.front()), last(ascending.back()), step(medianStep(ascending)) {}

    Span dividedBy(double divisor) const {
        Span out = *this;
        for (double* time : {&out.first, &out.last, &out.step}) *time /= divisor;
        return out;
    }
};

/// Time that both cover, of what either covers; negative when there is none.
double sharedPart(const Span& a, const Span& b) {
    const double common = std::min(a.last, b.last) - std::max(a.first, b.first);
    const double all = std::max(a.last, b.last) - std::min(a.first, b.first);
    return all > 0 ? common / all : 1;
}

/// Whether `in_seconds` and the other, in another unit, are of one time, with a rate that there can be.
bool fits(const Span& in_seconds, const Span& other) {
    return sharedPart(in_seconds, other) > kMostlyShared && other.step >= kShortestStep;
}

/// Whether the ground truth is of the images' time, for however much longer, with a rate that there can be.
bool covers(const Span& truth, const Span& images) {
    const double common = std::min(truth.last, images.last) - std::max(truth.first, images.first);
    return common >= kMostlyShared * (images.last - images.first) && truth.step >= kShortestStep &&
           truth.step <= kLongestStep;
}

template <class Entry>
void divideTimes(std::vector<Entry>& entries, double Entry::*time, double divisor) {
    for (Entry& entry : entries) entry.*time = roundToMicroseconds(entry.*time / divisor);
}

std::string unitName(double divisor) {
    return divisor == 1e3 ? "ms" : divisor == 1e6 ? "us" : "ns";
}

bool countsFrames(const GroundTruth& truth) {
    return std::all_of(truth.poses.begin(), truth.poses.end(),
                       [](const StampedPose& pose) { return isFrameNumber(pose.timestamp); });
}

}  // namespace

double medianStep(const std::vector<double>& ascending) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < ascending.size(); i++) steps.push_back(ascending[i] - ascending[i - 1]);
    return steps.empty() ? 0 : medianOf(steps);
}

bool isFrameNumber(double stamp) {
    return stamp >= 0 && stamp == std::floor(stamp);
}

bool numbersToSeconds(DatasetDescription& dataset) {
    if (!(dataset.frame_rate > 0) || !countsFrames(dataset.ground_truth)) return false;
    divideTimes(dataset.ground_truth.poses, &StampedPose::timestamp, dataset.frame_rate);
    return true;
}

double unitOfStamps(std::vector<double> stamps) {
    if (stamps.empty()) return 1;
    std::sort(stamps.begin(), stamps.end());
    const double step = medianStep(stamps), last = stamps.back();
    // Whole numbers of today may as well count ms, us or ns since a machine was turned on, weeks ago
    constexpr double kLongestLapse = 3600;  // s
    const bool decimals =
        std::any_of(stamps.begin(), stamps.end(), [](double t) { return t != std::floor(t); });
    double unit = 1;
    const auto longestStep = [&] {
        return decimals && last / unit > kYear2000 ? kLongestLapse : kLongestStep;
    };
    while (unit < 1e9 && (last / unit > kYear2100 || step / unit > longestStep())) unit *= 1000;
    return unit;
}

double unitOfImages(std::vector<double> stamps, DatasetDescription& dataset) {
    const double unit = unitOfStamps(std::move(stamps));
    if (unit == 1 || unit == dataset.time_unit) return unit;
    dataset.time_unit = unit;
    dataset.notes.push_back("times of the images are in " + unitName(unit) + ", as their size tells");
    return unit;
}

void settleCount(DatasetDescription& dataset, double rate) {
    auto& frames = dataset.frames;
    const bool whole = std::all_of(frames.begin(), frames.end(), [](const DatasetEntry& frame) {
        return isFrameNumber(frame.timestamp) && isFrameNumber(frame.depth_timestamp) &&
               frame.timestamp < kYear2000;
    });
    if (dataset.frame_rate > 0 || dataset.images || dataset.time_unit != 1 || frames.size() < 2 || !whole)
        return;
    if (!(rate > 0)) {
        dataset.notes.emplace_back(
            "warning: times of the images are whole numbers, which are taken as seconds: if they count "
            "frames, --frame-rate says how many come in a second");
        return;
    }
    divideTimes(frames, &DatasetEntry::timestamp, rate);
    divideTimes(frames, &DatasetEntry::depth_timestamp, rate);
    finishFrames(dataset);
    dataset.frame_rate = rate;
    dataset.notes.push_back("times are frame numbers at " + plainNumber(rate) + " Hz");
}

std::string toSeconds(GroundTruth& truth) {
    if (truth.poses.empty()) return {};
    const double unit =
        unitOfThisCentury(truth.poses.front().timestamp, truth.poses.back().timestamp, truth.poses.size());
    if (unit == 1) return {};
    divideTimes(truth.poses, &StampedPose::timestamp, unit);
    truth.copyable = false;
    return unitName(unit);
}

void settleClock(DatasetDescription& dataset) {
    auto& poses = dataset.ground_truth.poses;
    if (poses.empty() || dataset.frames.empty()) return;
    constexpr double kHardlyShared = 0.1;
    const Span images(stampsOf(dataset.frames)), truth(stampsOf(poses));
    const double shared = sharedPart(images, truth);
    if (dataset.frame_rate > 0 && countsFrames(dataset.ground_truth) &&
        sharedPart(images, truth.dividedBy(dataset.frame_rate)) > std::max(shared, kMostlyShared)) {
        numbersToSeconds(dataset);
        dataset.ground_truth.copyable = false;
        dataset.notes.emplace_back("the ground truth counts frames, as the images do");
        return;
    }
    if (shared > kHardlyShared) return;
    if (const std::string unit = toSeconds(dataset.ground_truth); !unit.empty()) {
        dataset.notes.push_back("times of the ground truth are in " + unit);
        return settleClock(dataset);
    }
    const double own = dataset.time_unit;
    for (const double divisor : {own, 1e3, 1e6, 1e9}) {
        const Span divided = truth.dividedBy(divisor);
        if (fits(images, divided) || (divisor == own && own > 1 && covers(divided, images))) {
            divideTimes(poses, &StampedPose::timestamp, divisor);
            dataset.ground_truth.copyable = false;
            dataset.notes.push_back("times of the ground truth are in " + unitName(divisor));
            return;
        }
        if (!dataset.images && fits(truth, images.dividedBy(divisor))) {
            divideTimes(dataset.frames, &DatasetEntry::timestamp, divisor);
            divideTimes(dataset.frames, &DatasetEntry::depth_timestamp, divisor);
            finishFrames(dataset);
            dataset.notes.push_back("times of the images are in " + unitName(divisor) +
                                    ", as the ground truth tells");
            return;
        }
    }
    if (shared >= 0) return;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "warning: the ground truth is of another time: images from %.3f to %.3f s, poses from %.3f to "
        "%.3f s",
        images.first, images.last, truth.first, truth.last);
    dataset.notes.emplace_back(text);
}

}  // namespace roevo
