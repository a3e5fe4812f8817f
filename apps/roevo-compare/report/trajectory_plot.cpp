#include <algorithm>
#include <array>
#include <cmath>

#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/plots.h"

namespace roevo {
namespace {

constexpr std::size_t kMaxPoints = 1500;               // of a line; more are not seen
constexpr int kViewWidth = 480;                        // px
constexpr int kBesideWidth = 94, kBesideHeight = 76;   // px that the axes' texts take
constexpr double kMargin = 0.12;                       // around the ground truth, as a share of its extent
constexpr double kMinGap = 1;                          // s: within it the line goes on, whatever the rate is
constexpr double kMinExtent = 0.02;                    // m: of a camera that stands
constexpr double kMinAspect = 0.42, kMaxAspect = 0.8;  // height to width of a picture

struct ViewLine {
    std::string name;
    LineStyle style;
    std::vector<StampedPose> poses;
};

struct Range {
    double low = INFINITY, high = -INFINITY;
    void include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double extent() const { return high - low; }
    void widenTo(double extent) {
        const double missing = std::max(0.0, extent - this->extent()) / 2;
        low -= missing;
        high += missing;
    }
};
using Box = std::array<Range, 3>;

// Two axes of the world as a picture shows them: right, and upwards.
struct View {
    std::string name;
    int right, up;
    bool flipped;  // the upward axis has its greater values below
};

Box boundingBox(const std::vector<StampedPose>& poses) {
    Box box;
    for (const StampedPose& pose : poses)
        for (int k = 0; k < 3; ++k)
            box[static_cast<std::size_t>(k)].include(pose.T_world_camera.translation()[k]);
    return box;
}

// Not "from above": where up is, no trajectory tells.
std::string seenAlong(int axis) {
    return std::string("Seen along ") + "xyz"[axis];
}

// Along the axis that the cameras' up points to on the whole, from above where cameras look ahead, and across
// it.
std::array<View, 2> chooseViews(const std::vector<StampedPose>& poses, const Box& box) {
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    for (const StampedPose& pose : poses) up -= pose.T_world_camera.linear().col(1);
    Eigen::Index vertical = 0;
    up.cwiseAbs().maxCoeff(&vertical);
    const int v = static_cast<int>(vertical);
    const bool down = up[vertical] < 0;
    const int a = (v + 1) % 3, b = (v + 2) % 3;  // right-handed with the positive axis
    const auto extent = [&](int k) { return box[static_cast<std::size_t>(k)].extent(); };
    const int wide = extent(a) >= extent(b) ? a : b;
    return {View{seenAlong(v), down ? b : a, down ? a : b, false},
            View{seenAlong(a + b - wide), wide, v, down}};
}

void add(std::string& script, const std::string& name, const std::vector<StampedPose>& poses,
         const View& view) {
    std::vector<std::vector<double>> rows;
    const std::vector<double> times = stampsOf(poses);
    const double gap = std::max(kMinGap, largestStep(times));
    std::size_t last = 0;
    for (const std::size_t i : evenly(poses.size(), kMaxPoints)) {
        bool is_joined = true;
        for (; last < i; ++last) is_joined = is_joined && times[last + 1] - times[last] <= gap;
        if (!is_joined) rows.push_back({NAN, NAN});
        const Eigen::Vector3d p = poses[i].T_world_camera.translation();
        rows.push_back({p[view.right], p[view.up]});
    }
    script += gnuplotData(name, rows);
}

std::string axisLabel(int axis) {
    return std::string("'") + "xyz"[axis] + " [m]'";
}

std::string rangeText(const Range& range, bool flipped) {
    const std::string low = exactNumber(range.low), high = exactNumber(range.high);
    return flipped ? "[" + high + ":" + low + "]" : "[" + low + ":" + high + "]";
}

std::string scriptFor(const View& view, const Range& right, const Range& up,
                      const std::vector<ViewLine>& lines) {
    std::string script =
        "unset key\nset size ratio -1\nset border 15\nset lmargin 9\nset rmargin 2\nset tmargin "
        "1\nset bmargin 2.5\nset xtics autofreq\n";
    script +=
        "set xlabel " + axisLabel(view.right) + " offset 0,0.4\nset ylabel " + axisLabel(view.up) + "\n";
    std::string plot;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string block = "line" + std::to_string(i);
        add(script, block, lines[i].poses, view);
        plot += (i == 0 ? "plot " : ", ") + std::string("$") + block + " using 1:2 with lines " +
                gnuplotStyle(lines[i].style);
    }
    const Eigen::Vector3d start = lines.front().poses.front().T_world_camera.translation();
    script += gnuplotData("start", {{start[view.right], start[view.up]}});
    plot += ", $start using 1:2 with points pt 7 ps 0.8 lc rgb '#222222'";
    return script + "set xrange " + rangeText(right, false) + "\nset yrange " + rangeText(up, view.flipped) +
           "\n" + plot + "\n";
}

// Every run that has poses, foreign methods first so that ours lie on top.
std::vector<ViewLine> linesOf(const SequenceResults& results, const Legend& legend, bool with_reference) {
    std::vector<ViewLine> lines;
    for (std::size_t i = 0; i < results.evaluated.size(); ++i) {
        const MethodRun& run = results.sequence->runs[i];
        const auto& evaluation = results.evaluated[i].evaluation;
        if (!run.ok() || run.trajectory.empty() || (with_reference && !evaluation)) continue;
        if (!allFinite(run.trajectory)) continue;
        const std::size_t m = legend.indexOf(run.method);
        ViewLine line{legend.methods[m].label, legend.styles[m], {}};
        if (with_reference) {
            line.poses = aligned(run.trajectory, *evaluation);
        } else {
            const Pose T_first_world = run.trajectory.front().T_world_camera.inverse();
            line.poses = run.trajectory;
            for (StampedPose& pose : line.poses) pose.T_world_camera = T_first_world * pose.T_world_camera;
        }
        lines.push_back(std::move(line));
    }
    std::stable_sort(lines.begin(), lines.end(),
                     [](const ViewLine& a, const ViewLine& b) { return a.style.width < b.style.width; });
    return lines;
}

// The part of the ground truth that the runs cover: it often begins earlier and ends later.
std::vector<StampedPose> coveredReference(const SequenceResults& results) {
    const auto& reference = results.sequence->reference;
    std::size_t first = reference.size(), last = 0;
    for (const EvaluatedRun& run : results.evaluated)
        if (run.evaluation) {
            first = std::min(first, run.evaluation->pairs.front().reference);
            last = std::max(last, run.evaluation->pairs.back().reference);
        }
    if (reference.empty() || first > last) return {};
    return {reference.begin() + static_cast<std::ptrdiff_t>(first),
            reference.begin() + static_cast<std::ptrdiff_t>(last) + 1};
}

// Names of those with a point outside.
std::string leavingNames(const std::vector<ViewLine>& lines, const Box& box) {
    std::string names;
    for (const ViewLine& line : lines) {
        const bool leaves = std::any_of(line.poses.begin(), line.poses.end(), [&](const StampedPose& pose) {
            for (int k = 0; k < 3; ++k) {
                const double x = pose.T_world_camera.translation()[k];
                const Range& range = box[static_cast<std::size_t>(k)];
                if (x < range.low || x > range.high) return true;
            }
            return false;
        });
        if (leaves) names += (names.empty() ? "" : ", ") + line.name;
    }
    return names;
}

}  // namespace

std::vector<Figure> trajectoryFigures(const SequenceResults& results, const Legend& legend) {
    const std::vector<StampedPose> reference = coveredReference(results);
    std::vector<ViewLine> lines = linesOf(results, legend, !reference.empty());
    if (lines.empty()) return {{"", "", "No run has a trajectory that could be drawn."}};

    // What is shown is what the ground truth needs, so that one that runs away does not squash the others.
    const auto& frame = reference.empty() ? lines.back().poses : reference;
    Box box = boundingBox(frame);
    double largest = kMinExtent;
    for (const Range& range : box) largest = std::max(largest, range.extent());
    for (Range& range : box) range.widenTo(range.extent() + 2 * kMargin * largest);
    const auto views = chooseViews(frame, box);

    double aspect = kMinAspect;
    for (const View& view : views)
        aspect = std::max(aspect, box[static_cast<std::size_t>(view.up)].extent() /
                                      box[static_cast<std::size_t>(view.right)].extent());
    aspect = std::min(aspect, kMaxAspect);
    const int height = static_cast<int>((kViewWidth - kBesideWidth) * aspect) + kBesideHeight;

    Box shown = box;
    std::vector<Figure> figures;
    if (!reference.empty()) lines.insert(lines.begin(), {"ground truth", groundTruthStyle(), reference});
    for (const View& view : views) {
        Range right = box[static_cast<std::size_t>(view.right)], up = box[static_cast<std::size_t>(view.up)];
        right.widenTo(up.extent() / aspect);
        up.widenTo(right.extent() * aspect);
        shown[static_cast<std::size_t>(view.right)].widenTo(right.extent());
        shown[static_cast<std::size_t>(view.up)].widenTo(up.extent());
        const std::string name = results.sequence->name + ": trajectories, " + view.name;
        figures.push_back(drawFigure(scriptFor(view, right, up, lines), kViewWidth, height, name, view.name));
        for (const ViewLine& line : lines) figures.back().lines.emplace_back(line.name, line.style);
    }
    const std::string leaving = leavingNames(lines, shown);
    if (!leaving.empty()) figures.back().note += ". Leaving the picture: " + leaving;
    return figures;
}

}  // namespace roevo
