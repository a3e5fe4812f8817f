#include "frame_preparer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stopwatch.h"

namespace roevo {
namespace {

/// Pixels per edge point, at least: twice as many points as in a cluttered office. An image of noise has
/// more, and no use for them.
constexpr std::size_t kPixelsPerPoint = 12;

}  // namespace

void keepLongest(OrganizedEdges& edges, std::size_t most_points) {
    if (edges.size() <= most_points) return;
    std::vector<std::size_t> order(static_cast<std::size_t>(edges.numEdges()));
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return edges.pointsOf(a).size() > edges.pointsOf(b).size();
    });
    std::size_t points = 0, kept = 0;
    while (kept < order.size() && points + edges.pointsOf(order[kept]).size() <= most_points)
        points += edges.pointsOf(order[kept++]).size();
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept));
    OrganizedEdges out;
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < kept; ++k) {
        const IndexRange own = edges.pointsOf(order[k]);
        all.resize(own.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        out.addEdge(edges, own.first, all);
    }
    edges = std::move(out);
}

Fault FramePreparer::faultOf(const RgbdFrame& images) {
    if (const Fault fault = inputFault(images, camera_, last_timestamp_)) return fault;
    return std::isfinite(last_timestamp_) ? leaps_.check(images.timestamp, last_timestamp_) : Fault();
}

PreparedFrame::Content FramePreparer::prepare(const RgbdFrame& images) {
    return prepare(images, [&](RgbdFrame& own) {
        if (keeps_) own = RgbdFrame();  // these buffers may be somebody else's, too
        own.timestamp = images.timestamp;
        images.grey.copyTo(own.grey);
        images.depth.copyTo(own.depth);
        images.colour.copyTo(own.colour);
        images.mask.copyTo(own.mask);
    });
}

PreparedFrame::Content FramePreparer::prepare(RgbdFrame&& images) {
    keeps_ = true;
    return prepare(images, [&](RgbdFrame& own) { own = std::move(images); });
}

template <typename Take>
PreparedFrame::Content FramePreparer::prepare(const RgbdFrame& images, const Take& take) {
    const Stopwatch watch;
    PreparedFrame::Content out;
    out.by = this;
    out.timestamp = images.timestamp;
    out.fault = faultOf(images);
    if (out.fault) return out;
    last_timestamp_ = images.timestamp;
    out.frame = spare();
    Frame& frame = *out.frame;
    take(frame.images);
    front_end_.process(frame);
    const auto pixels = static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
    if (frame.edges.size() * kPixelsPerPoint > pixels) {
        keepLongest(frame.edges, pixels / kPixelsPerPoint);
        frame.grid.build(frame.edges, camera_.width, camera_.height);
    }
    out.milliseconds = watch.milliseconds();
    return out;
}

std::unique_ptr<Frame> FramePreparer::spare() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (spare_.empty()) return std::make_unique<Frame>();
    std::unique_ptr<Frame> frame = std::move(spare_.back());
    spare_.pop_back();
    return frame;
}

void FramePreparer::giveBack(std::unique_ptr<Frame> frame) {
    if (!frame) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    spare_.push_back(std::move(frame));
}

}  // namespace roevo
