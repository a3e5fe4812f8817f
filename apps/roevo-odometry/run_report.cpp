#include "run_report.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>

#include "camera/off_centre.h"
#include "programs/text.h"

namespace roevo {
namespace {

std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));
std::string format(const char* pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

std::string joined(const std::vector<MapRefusal>& refusals) {
    std::string text;
    for (const MapRefusal& refusal : refusals) text += (text.empty() ? "" : "; ") + describe(refusal);
    return text;
}

}  // namespace

std::string Losses::toText() const {
    const auto times = [](std::size_t count) {
        return count == 1 ? std::string("once") : std::to_string(count) + " times";
    };
    std::string text = "lost " + times(lost);
    if (found_in_map) text += ", found in the map";
    if (found_again > 0) text += ", found again " + times(found_again);
    if (regained > 0) text += ", regained by tracking " + times(regained);
    if (joined > 0) text += ", begun anew and joined later " + times(joined);
    return to_the_end ? text + (lost == 1 ? ", to the end" : ", the last time to the end") : text;
}

Losses RunReport::losses() const {
    Losses out;
    const FrameResult* const first_in_map = localised();
    std::size_t joins = 0;
    bool tracked = false;
    for (const FrameRecord& f : frames) {
        const FrameResult& r = f.result;
        if (r.status == FrameStatus::kRejected) continue;
        const bool failed = r.status == FrameStatus::kPredicted || r.status == FrameStatus::kLost;
        const bool found = r.found_at >= 0, begun = r.status == FrameStatus::kInitialised;
        const bool is_first_in_map = &r == first_in_map;
        if ((failed || found) && tracked) ++out.lost;
        if (!failed && !tracked && !found && !begun) ++out.regained;
        tracked = !failed;
        if (begun && !found) ++out.pieces;
        if (found && !begun) {
            out.found_again += !is_first_in_map;
            out.found_in_map |= is_first_in_map;
        }
        if (r.joined_at >= 0) {
            ++joins;
            out.joined += !is_first_in_map;
        }
        if (r.closed_at >= 0) ++out.loops_closed;
    }
    out.to_the_end = out.lost > 0 && !tracked;
    if (first_in_map != nullptr) ++out.pieces;  // the map's own
    out.pieces -= std::min(out.pieces, joins);
    return out;
}

std::vector<int> RunReport::segments() const {
    std::map<int, int> track_of, numbers;  // those of map_in are in the first track of all
    for (const KeyframeInfo& keyframe : keyframes) track_of[keyframe.id] = keyframe.track;
    std::vector<int> segments;
    for (const FrameRecord& frame : frames) {
        const auto next = static_cast<int>(numbers.size()) + 1;
        segments.push_back(frame.result.hasPose()
                               ? numbers.emplace(track_of[frame.result.keyframe], next).first->second
                               : 0);
    }
    return segments;
}

int RunReport::mapKeyframeOf(const FrameResult& frame) const {
    for (const int keyframe : {frame.found_at, frame.joined_at})
        if (map_in && keyframe >= 0 && keyframe < map_in->keyframes) return keyframe;
    return -1;
}

const FrameResult* RunReport::localised() const {
    const auto first = std::find_if(frames.begin(), frames.end(),
                                    [&](const FrameRecord& f) { return mapKeyframeOf(f.result) >= 0; });
    return first == frames.end() ? nullptr : &first->result;
}

int RunReport::mapSegment() const {
    // A keyframe may have been recognised only when the last frame had been
    const auto isInMap = [&](const FrameResult& frame) {
        return mapKeyframeOf(frame) >= 0 ||
               std::any_of(keyframes.begin(), keyframes.end(), [&](const KeyframeInfo& k) {
                   return k.id == frame.keyframe && map_in && k.track < map_in->keyframes;
               });
    };
    const auto first =
        std::find_if(frames.begin(), frames.end(), [&](const FrameRecord& f) { return isInMap(f.result); });
    return first == frames.end() ? 0 : segments()[static_cast<std::size_t>(first - frames.begin())];
}

std::size_t RunReport::leftOut() const {
    if (map_out.file.empty()) return 0;
    std::map<int, std::size_t> sizes;  // of the tracks; with map_in, the first one of all is that
    for (const KeyframeInfo& keyframe : keyframes) ++sizes[keyframe.track];
    std::size_t joined = 0;
    for (const auto& [track, size] : sizes)
        if (map_in ? track == 0 : size > joined) joined = size;
    return keyframes.size() - joined;
}

std::size_t RunReport::covered() const {
    if (map_out.file.empty()) return 0;
    const int added = map_out.keyframes - (map_in ? map_in->keyframes : 0);
    return keyframes.size() - leftOut() - static_cast<std::size_t>(added);
}

double RunReport::pathLength() const {
    const std::vector<int> pieces = segments();
    double length = 0;
    int before = 0;  // the piece of the pose before
    std::size_t pose = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!frames[i].result.hasPose()) continue;
        if (pieces[i] == before)
            length += (trajectory[pose].T_world_camera.translation() -
                       trajectory[pose - 1].T_world_camera.translation())
                          .norm();
        before = pieces[i];
        ++pose;
    }
    return length;
}

std::string RunReport::mapWarning() const {
    if (!map_in) return {};
    const int segment = mapSegment();
    if (segment == 0)
        return map_in->file + ": never recognised in the map: the trajectory is in a world of its own" +
               (map_out.file.empty() ? "" : ", and nothing is added to the map");
    const std::vector<int> pieces = segments();
    const int all = *std::max_element(pieces.begin(), pieces.end());
    if (all < 2) return {};
    return map_in->file +
           format(
               ": only segment %d of %d (see frames.csv) is in the map's world; where the rest is in it was "
               "not measured",
               segment, all);
}

std::string RunReport::evaluationWarning() const {
    if (!evaluation || 2 * evaluation->pairs.size() >= trajectory.size()) return {};
    return ground_truth +
           format(": only %zu of the %zu poses have ground truth within %g s: the errors are of these",
                  evaluation->pairs.size(), trajectory.size(), kDefaultMaxDt);
}

std::string RunReport::cameraWarning() const {
    constexpr double kMostOff = 0.25;
    if (offCentre(camera) <= kMostOff) return {};
    return format(
               "the optical axis is far from the middle of the image: pixel %.1f, %.1f of %d x %d. Are these "
               "the intrinsics of another image size? They are from ",
               camera.cx, camera.cy, camera.width, camera.height) +
           camera_source;
}

std::size_t RunReport::count(FrameStatus status) const {
    return static_cast<std::size_t>(std::count_if(
        frames.begin(), frames.end(), [&](const FrameRecord& f) { return f.result.status == status; }));
}

std::size_t RunReport::dropped() const {
    return static_cast<std::size_t>(
        std::count_if(frames.begin(), frames.end(), [](const FrameRecord& f) { return f.dropped; }));
}

namespace {

/// "29 of them: " and the commonest reason among the frames that count; empty where none does.
template <class Counts>
std::string commonestReason(const std::vector<FrameRecord>& frames, const Counts& counts) {
    std::map<std::string, std::vector<const FrameRecord*>> reasons;
    for (const FrameRecord& f : frames)
        if (counts(f)) reasons[reasonWithoutFile(f.result.reason)].push_back(&f);
    if (reasons.empty()) return {};
    const auto commonest = std::max_element(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) {
        return a.second.size() < b.second.size();
    });
    return format("%zu of them: ", commonest->second.size()) + commonest->second.front()->result.reason;
}

}  // namespace

std::string RunReport::failure() const {
    const auto broken = std::find_if(trajectory.begin(), trajectory.end(),
                                     [](const StampedPose& p) { return !p.T_world_camera.isFinite(); });
    if (broken != trajectory.end())
        return format(
            "the pose of the frame at %.6f s is not a number, which is a fault of this program; "
            "please report it with the options and the recording",
            broken->timestamp);
    const std::size_t initialised = count(FrameStatus::kInitialised);
    if (count(FrameStatus::kOk) > 0 || (initialised > 0 && frames.size() == initialised)) return {};
    const std::string why = commonestReason(
        frames, [](const FrameRecord& f) { return f.result.status != FrameStatus::kInitialised; });
    if (why.empty()) return "there is no frame";
    return format("none of the %zu frames could be tracked; ", frames.size()) + why;
}

std::string RunReport::rejectionWarning() const {
    const std::size_t rejected = count(FrameStatus::kRejected) - dropped();
    const std::size_t taken = frames.size() - dropped();
    if (rejected == 0 || 2 * rejected < taken) return {};
    return format("%zu of the %zu frames are rejected, ", rejected, taken) +
           commonestReason(frames, [](const FrameRecord& f) {
               return f.result.status == FrameStatus::kRejected && !f.dropped;
           });
}

std::string reasonWithoutFile(const std::string& reason) {
    const std::size_t colon = reason.rfind(": ");
    const bool names_file = colon != std::string::npos && reason.find('/', colon) != std::string::npos;
    return names_file ? reason.substr(0, colon) : reason;
}

std::string framesCsv(const RunReport& report) {
    std::string csv =
        "timestamp,status,reason,keyframe,edges,points,matched_ratio,inliers,sigma_t_m,sigma_r_deg,"
        "ms_decode,ms_edges,ms_coarse,ms_fine,ms_total,ms_mapping,ms_waiting,map_correction_m,map_correction_"
        "deg,map_reason,segment\n";
    const std::vector<int> segments = report.segments();
    for (std::size_t i = 0; i < report.frames.size(); ++i) {
        const FrameRecord& f = report.frames[i];
        const FrameResult& r = f.result;
        csv += format("%.6f,%s,", r.timestamp, toString(r.status)) + csvField(r.reason) +
               format(",%d,%d,%d,%.4f,%d,%.6f,%.5f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.6f,%.5f,",
                      r.new_keyframe ? 1 : 0, r.num_edges, r.num_points, r.matched_ratio, r.inliers,
                      r.sigmaTranslation(), r.sigmaRotationDeg(), f.ms_decode, r.ms.edges, r.ms.coarse,
                      r.ms.fine, r.ms.total, r.ms.mapping, r.ms.waiting, r.map_correction,
                      r.map_turn / kDegree) +
               csvField(joined(r.map_refusals)) + "," + std::to_string(segments[i]) + "\n";
    }
    return csv;
}

std::string covariancesText(const RunReport& report) {
    std::string text =
        "# Covariance of each pose T_world_camera, as it was known when its frame was processed\n"
        "# order: position x y z, orientation x y z; both along the axes of the world of "
        "trajectory_live.txt\n"
        "# units: m and rad, so m^2, m rad and rad^2; an orientation error phi is meant as R <- exp(phi) R\n";
    if (const FrameResult* const found = report.localised())
        text += format(
            "# relative to the first keyframe of the map from %.6f on, and to the run's own start before\n",
            found->timestamp);
    text += "# timestamp, then the 6x6 matrix row by row: 37 columns\n";
    for (const FrameRecord& f : report.frames) {
        if (!f.result.hasPose()) continue;
        text += format("%.6f", f.result.timestamp);
        for (int row = 0; row < 6; ++row)
            for (int column = 0; column < 6; ++column)
                text += format(" %.9g", f.result.covariance(row, column));
        text += '\n';
    }
    return text;
}

}  // namespace roevo
