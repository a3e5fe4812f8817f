#pragma once
#include <cstdint>
#include <vector>

#include "tracking/fault.h"
#include "tracking/fine_tracker.h"
#include "tracking/frame.h"
#include "tracking/motion_model.h"
#include "tracking/relative_pose.h"

namespace roevo {

/// What tracking a frame against a keyframe came to.
struct Tracking {
    RelativePose pose;
    /// Of the pose, if the motion of its rows were known; stays as it was tracked where the frame becomes the
    /// reference, against which it errs nothing.
    PoseUncertainty measured;
    RowMotion rows;  ///< how the camera moved while the image was read
    Brightness brightness;
    EdgeMatches matches;              ///< at that pose
    int inliers = 0;                  ///< of them (in mode ct: all of them)
    std::vector<std::int32_t> found;  ///< of each of the keyframe's edges: inliers
    Fault fault;                      ///< why the frame is lost; or why the search was needed
    Fault depth_fault;                ///< how the frame's depth contradicts: it was left out, unless...
    bool doubtful = false;            ///< ... the pose may be what is wrong
    bool tracked = false, searched = false;
    double ms_coarse = 0, ms_fine = 0;

    bool lost() const { return !tracked; }
    void reject(const Fault& why) {
        tracked = false;
        fault = why;
    }
    /// The pose may be far off: its sigma says so.
    void doubt();
    double matchedRatio() const { return matches.matchedRatio(); }
};

/// Tracks frames against a keyframe: coarse photometric alignment, then registration by organized edges (Sec.
/// V). Keeps buffers only: no call depends on the ones before. Experiments put something else in the place of
/// a step by overriding it.
class Tracker {
  public:
    /// @param camera   with its lens
    /// @param options  as given: scaled to the camera here
    Tracker(const PinholeCamera& camera, const OdometryOptions& options);
    virtual ~Tracker() = default;

    /// From the predicted pose and from standing still.
    [[nodiscard]] Tracking track(const Keyframe& reference, const Frame& frame, const Prediction& prediction);
    /// From rotations about the camera's x and y axes around the last pose, up to 18 degrees each: where to
    /// look when the camera turned faster than track() converges. @return `failed` itself where nothing is
    /// found
    [[nodiscard]] Tracking search(const Keyframe& reference, const Frame& frame, const Prediction& prediction,
                                  Tracking failed);
    /// From one pose.
    [[nodiscard]] Tracking trackFrom(const Keyframe& reference, const Frame& frame,
                                     const Prediction& prediction, const Pose& T_keyframe_camera);

    /// Adds what a tracked frame tells of the read-out time, where that is worth its time.
    void learnReadout(const Keyframe& reference, const Frame& frame, const Tracking& tracking,
                      const RollingShutter& shutter, ReadoutEstimator& estimator);

    /// The points of a new keyframe that coarse tracking aligns.
    virtual PhotometricPoints choosePoints(const EdgePoints3D& edges, const Frame& frame,
                                           const RowMotion& rows) const;

  protected:
    /// Coarse alignment, Eqs. (2), (3). @param guesses  of T_current_keyframe
    virtual CoarseResult align(const Keyframe& reference, const Frame& frame, const RollingShutter& shutter,
                               const std::vector<Pose>& guesses, const Brightness& brightness);
    /// Refines a coarse pose (T_current_keyframe). Of the result its pose, uncertainty and `converged` count;
    /// whether the frame is tracked is judged by assessing its pose, as ever, with edges associated anew.
    virtual FineResult refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                              const PosePrior& prior, const RollingShutter& shutter,
                              const Brightness& brightness);

    const PinholeCamera camera_, ideal_;
    const OdometryOptions options_;  ///< scaled to the camera

  private:
    /// @param guesses  of T_current_keyframe
    Tracking run(const Keyframe& reference, const Frame& frame, const Prediction& prediction,
                 const std::vector<Pose>& guesses, const PosePrior& prior);
    Fault runCoarse(const Keyframe& reference, const Frame& frame, const CoarseResult& aligned,
                    const RollingShutter& shutter, Tracking& out);
    Fault runFine(const Keyframe& reference, const Frame& frame, const CoarseResult& aligned,
                  const PosePrior& prior, const RollingShutter& shutter, Tracking& out);

    CoarseTracker coarse_;
    FineTracker fine_;
};

}  // namespace roevo
