#include "repeatability/measure.h"

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>

#include "programs/progress.h"
#include "repeatability/methods.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kLargestGap = 0.1;  // s, between poses that are interpolated
constexpr double kSameTime = 1e-6;   // s

std::vector<Eigen::Vector3d> pointsOf(const EdgePoints3D& edges) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < edges.size(); ++i) points.push_back(edges.points.at(i));
    return points;
}

// A reference frame and what each method has made of its features since.
struct Reference {
    Reference(std::shared_ptr<FeatureFrame> of, const PinholeCamera& camera, const OdometryOptions& options)
        : frame(std::move(of)), corners(*frame, camera, options), edge_points(pointsOf(frame->lifted)) {
        for (int e = 0; e < frame->lifted.image.numEdges(); ++e) nearest.push_back({e});
        normals = nearest;
    }

    std::shared_ptr<FeatureFrame> frame;
    CornerTracks corners;
    std::vector<Eigen::Vector3d> edge_points;
    EdgeLinks nearest, normals;  // chained to the edges of the last frame
};

/// The poses of one recording.
struct Poses {
    std::vector<StampedPose> odometry;
    std::vector<StampedPose> judging;    ///< where features truly are
    std::vector<StampedPose> searching;  ///< edges are reprojected at these to be associated
    std::vector<double> keyframe_times;
    std::size_t frames = 0;
};

class Measurement {
  public:
    Measurement(const StudyInput& input, const ReferencePlan& plan, const Poses& poses, std::string label)
        : input_(input),
          plan_(plan),
          poses_(poses),
          label_(std::move(label)),
          extractor_(input.camera, input.options),
          sets_(input.camera, input.options) {}

    Repeatability run() {
        Progress progress(label_, poses_.frames);
        const auto source = input_.open();
        std::size_t number = 0;
        for (SourceFrame frame; source->next(frame); ++number) {
            progress.update(number + 1);
            last_ = frame.timestamp;
            if (number == 0) first_ = last_;
            const auto odometry = poseAt(poses_.odometry, frame.timestamp, kLargestGap);
            const auto judging = poseAt(poses_.judging, frame.timestamp, kLargestGap);
            const auto searching = poseAt(poses_.searching, frame.timestamp, kLargestGap);
            if (!frame.fault.empty() || !odometry || !judging || !searching) {
                ++result_.left_out;
                continue;
            }
            auto current = extractor_.extract(frame.frame, number);
            current->T_world_camera = *judging;
            current->T_world_search = *searching;
            current->T_world_odometry = *odometry;
            add(std::move(current));
        }
        progress.finish();
        if (result_.rows.empty())
            throw std::runtime_error(input_.path + ": no two frames with poses and features to compare" +
                                     lackOfPoses());
        return std::move(result_);
    }

  private:
    std::string lackOfPoses() const {
        if (result_.references > 0 || poses_.judging.empty()) return "";
        return format("; frames from %.3f to %.3f s, poses of the ground truth from %.3f to %.3f s", first_,
                      last_, poses_.judging.front().timestamp, poses_.judging.back().timestamp);
    }

    void add(std::shared_ptr<FeatureFrame> current) {
        const bool reference =
            references_.empty() || current->number >= references_.back().frame->number + plan_.every;
        while (!references_.empty() && current->number > references_.front().frame->number + plan_.follow)
            references_.pop_front();
        sets_.insert(*current, reference || isKeyframe(current->timestamp));
        if (previous_) {
            const EdgeLinks nearest = step(*previous_, *current, EdgeRule::kNearest);
            const EdgeLinks normals = step(*previous_, *current, EdgeRule::kNormals);
            for (Reference& one : references_) {
                one.corners.advance(*previous_, *current);
                one.nearest = chain(one.nearest, nearest);
                one.normals = chain(one.normals, normals);
                compare(one, *current);
            }
        }
        if (reference) {
            references_.emplace_back(current, input_.camera, input_.options);
            ++result_.references;
        }
        if (!references_.empty()) sets_.forgetBefore(references_.front().frame->number);
        previous_ = std::move(current);
    }

    EdgeLinks step(const FeatureFrame& from, const FeatureFrame& to, EdgeRule rule) const {
        return associateEdges(from, to, rule, input_.camera, input_.options);
    }

    void compare(const Reference& reference, const FeatureFrame& current) {
        const FeatureFrame& from = *reference.frame;
        const Pose T_current_reference = current.T_world_camera.inverse() * from.T_world_camera;
        const TrueView corners =
            trueView(reference.corners.points(), T_current_reference, current, input_.camera);
        const TrueView edges = trueView(reference.edge_points, T_current_reference, current, input_.camera);
        const auto judged = [&](const EdgeLinks& links) {
            return judgeEdges(from.lifted.image, edges, links, current.lifted.image, current.lifted_grid);
        };
        const Verdict verdicts[] = {judgePoints(corners, reference.corners.positions()),
                                    judged(reference.nearest), judged(reference.normals),
                                    judged(step(from, current, EdgeRule::kNormals)),
                                    judged(sets_.links(from.number))};
        RepeatabilityRow row;
        row.reference = from.number;
        row.frame = current.number;
        row.rotation_deg = rotationAngle(T_current_reference) / kDegree;
        row.translation = T_current_reference.translation().norm();
        row.disagreement = disagreement(reference, current, edges);
        row.visible_corners = corners.num_visible;
        row.visible_points = edges.num_visible;
        for (std::size_t m = 0; m < kNumAssociationMethods; ++m) {
            row.share[m] = verdicts[m].share();
            row.precision[m] = verdicts[m].precision();
        }
        result_.rows.push_back(row);
    }

    double disagreement(const Reference& reference, const FeatureFrame& current,
                        const TrueView& judged) const {
        const Pose T_odometry = current.T_world_odometry.inverse() * reference.frame->T_world_odometry;
        const PinholeCamera ideal = input_.camera.undistorted();
        std::vector<double> distances;
        for (std::size_t i = 0; i < judged.visible.size(); ++i) {
            if (judged.visible[i] == 0) continue;
            const Eigen::Vector3d point = T_odometry * reference.edge_points[i];
            if (point.z() > 0)
                distances.push_back((ideal.project(point) - Eigen::Vector2d(static_cast<double>(judged.u[i]),
                                                                            static_cast<double>(judged.v[i])))
                                        .norm());
        }
        return median(std::move(distances)).value_or(0);
    }

    bool isKeyframe(double time) const {
        const auto next =
            std::lower_bound(poses_.keyframe_times.begin(), poses_.keyframe_times.end(), time - kSameTime);
        return next != poses_.keyframe_times.end() && *next < time + kSameTime;
    }

    const StudyInput& input_;
    ReferencePlan plan_;
    const Poses& poses_;
    std::string label_;
    FeatureExtractor extractor_;
    DisjointSets sets_;
    std::deque<Reference> references_;
    std::shared_ptr<FeatureFrame> previous_;
    Repeatability result_;
    double first_ = 0, last_ = 0;  // s, of the frames
};

double medianDisagreement(const Repeatability& measured) {
    std::vector<double> all;
    for (const RepeatabilityRow& row : measured.rows) all.push_back(row.disagreement);
    return median(std::move(all)).value_or(0);
}

}  // namespace

std::optional<Pose> poseAt(const std::vector<StampedPose>& trajectory, double time, double max_gap) {
    const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                        [](const StampedPose& pose, double t) { return pose.timestamp < t; });
    if (after != trajectory.end() && after->timestamp - time < kSameTime) return after->T_world_camera;
    if (after == trajectory.begin()) return std::nullopt;
    const StampedPose& before = *(after - 1);
    if (time - before.timestamp < kSameTime) return before.T_world_camera;
    if (after == trajectory.end() || after->timestamp - before.timestamp > max_gap) return std::nullopt;
    return interpolate(before.T_world_camera, after->T_world_camera,
                       (time - before.timestamp) / (after->timestamp - before.timestamp));
}

Repeatability measureRepeatability(const StudyInput& input, const ReferencePlan& plan) {
    const StudyRun odometry = trackRecording(input, input.options);
    const bool truth = !input.ground_truth.empty();
    Poses poses{odometry.trajectory, input.ground_truth, odometry.trajectory, odometry.keyframe_times,
                odometry.frames};
    if (!truth && input.options.mode == Mode::kBundleAdjustment) poses.judging = poses.odometry;
    if (!truth && input.options.mode != Mode::kBundleAdjustment) {
        OdometryOptions options = input.options;
        options.mode = Mode::kBundleAdjustment;
        poses.judging = trackRecording(input, options).trajectory;
    }
    const std::string label = "repeatability of " + input.name;
    Repeatability measured = Measurement(input, plan, poses, label).run();
    measured.disagreement = medianDisagreement(measured);
    const bool exact = truth && measured.disagreement <= kExactPoses;
    if (exact) {  // then the odometry, which saw these very associations, need not be asked
        const double disagreement = measured.disagreement;
        poses.searching = poses.judging;
        measured = Measurement(input, plan, poses, label + ", at the ground truth").run();
        measured.disagreement = disagreement;
    }
    measured.judged_by = truth ? "ground truth" : "roevo-ba";
    measured.searched_by = exact ? "ground truth" : "roevo-" + std::string(toString(input.options.mode));
    return measured;
}

}  // namespace roevo
