#include <algorithm>
#include <utility>

#include "distance_field.h"
#include "families.h"
#include "odometry_frame.h"
#include "roevo/odometry.h"
#include "tracking/tracker.h"

namespace roevo {
namespace {

/// alpha^2 of the joined residual. Not ROEVO's own weight: the field agrees less well with itself than
/// associated edges, and is better off with more help.
constexpr double kPhotometricWeight = 0.3;

/// ROEVO's tracker with the field in place of fine tracking.
class FieldTracker : public Tracker {
  public:
    FieldTracker(const PinholeCamera& camera, const OdometryOptions& options, bool photometric)
        : Tracker(camera, options), field_(camera, options_.fine, photometric ? kPhotometricWeight : 0) {}
    DistanceFieldTracker::Times takeTimes() { return field_.takeTimes(); }

  protected:
    FineResult refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                      const PosePrior& prior, const RollingShutter& shutter,
                      const Brightness& brightness) override {
        return field_.track(reference, frame, T_start, prior, shutter, brightness);
    }

  private:
    DistanceFieldTracker field_;
};

class DistanceFieldMethod : public Method {
  public:
    DistanceFieldMethod(const PinholeCamera& camera, const OdometryOptions& options, bool photometric)
        : DistanceFieldMethod(camera, trackingOnly(options),
                              std::make_unique<FieldTracker>(camera, trackingOnly(options), photometric)) {}

    std::vector<std::string> stages() const override {
        return {"edges", "coarse", "distance field", "registration", "keyframe rule"};
    }

    MethodFrame processFrame(const RgbdFrame& frame) override {
        const FrameResult result = odometry_.processFrame(frame);
        const DistanceFieldTracker::Times times = tracker_.takeTimes();
        MethodFrame out = toMethodFrame(result, started_);
        // Edges are associated afterwards, as the rule for new keyframes wants it
        const double rest = std::max(0.0, result.ms.fine - times.field - times.registration);
        out.stage_ms = {result.ms.edges, result.ms.coarse, times.field, times.registration, rest};
        return out;
    }
    void refused(const RgbdFrame& frame) override { (void)odometry_.processFrame(frame); }

  private:
    DistanceFieldMethod(const PinholeCamera& camera, const OdometryOptions& options,
                        std::unique_ptr<FieldTracker> tracker)
        : tracker_(*tracker), odometry_(camera, options, Pose::Identity(), std::move(tracker)) {}
    static OdometryOptions trackingOnly(OdometryOptions options) {
        options.mode = Mode::kTracking;
        return options;
    }

    FieldTracker& tracker_;  // the odometry's
    Odometry odometry_;
    bool started_ = false;
};

}  // namespace

std::vector<MethodInfo> distanceFieldMethods() {
    MethodInfo alone, joined;
    alone.name = "distance-field";
    alone.label = "Distance field";
    alone.note =
        "exact Euclidean distance field of the edge mask in place of ROEVO's fine tracking; edges, lifting "
        "to "
        "3-D, coarse tracking, choice of the start, motion model, keyframe rule and the test of being lost "
        "(which associate edges once more) are ROEVO's, so compare it with ROEVO TR; without association it "
        "has no residual in depth";
    joined.name = "distance-field-photometric";
    joined.label = "Distance field + photometric";
    joined.note =
        "the same, its residual joined with the photometric one as in ROEVO's fine tracking, which counts "
        "six times as much here as there";
    alone.make = makerOf<DistanceFieldMethod>(false);
    joined.make = makerOf<DistanceFieldMethod>(true);
    return {alone, joined};
}

}  // namespace roevo
