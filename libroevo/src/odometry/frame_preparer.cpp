#include "frame_preparer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

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

std::uint64_t FramePreparer::nextId() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

cv::Mat FramePreparer::sceneOf(RgbdFrame& images) const {
    if (images.mask.empty()) return {};
    // The outline of what is masked is an edge, too, and takes its depth from some pixels beside it.
    const int margin = static_cast<int>(std::lround(0.01 * images.mask.cols));
    const cv::Size around(2 * margin + 1, 2 * margin + 1);
    cv::Mat scene, ideal;
    cv::erode(images.mask, scene, cv::getStructuringElement(cv::MORPH_RECT, around));
    if (!images.depth.empty()) {
        cv::Mat depth;  // the images may be somebody else's, too
        images.depth.copyTo(depth, scene);
        images.depth = depth;
    }
    return undistorter_.apply(scene, ideal);
}

void FramePreparer::findEdges(Frame& frame) {
    const cv::Mat& grey = undistorter_.apply(frame.images.grey, frame.ideal_grey);
    extractor_.extract(grey, frame.edges, frame.mask, sceneOf(frame.images));
    keepLongest(frame.edges, grey.total() / kPixelsPerPoint);
    frame.grid.build(frame.edges, grey.cols, grey.rows);
    frame.pyramid.build(grey, levels_);
}

Fault FramePreparer::faultOf(const RgbdFrame& images) {
    if (Fault fault = inputFault(images, camera_, stamps_.last())) return fault;
    return stamps_.take(images.timestamp);
}

PreparedFrame::Content FramePreparer::prepare(RgbdFrame images) {
    const Stopwatch watch;
    PreparedFrame::Content out;
    out.by = id_;
    out.timestamp = images.timestamp;
    out.fault = faultOf(images);
    if (out.fault) return out;
    out.frame = spare();
    out.frame->images = std::move(images);
    findEdges(*out.frame);
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
