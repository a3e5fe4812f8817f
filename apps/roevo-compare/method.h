#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/options.h"
#include "roevo/types.h"

namespace roevo {

/// What a method makes of one frame.
struct MethodFrame {
    bool tracked = false;                ///< the motion to this frame was measured (or it is the first)
    std::optional<Pose> T_world_camera;  ///< none: no pose for this frame
    std::string reason;                  ///< in words, when not tracked
    std::vector<double> stage_ms;        ///< in the order of Method::stages()
};

/// A visual odometry under comparison. Frames come in time order, as the lens saw them, depth registered to
/// colour.
class Method {
  public:
    virtual ~Method() = default;

    /// Names of the stages that are timed apart; may be empty.
    virtual std::vector<std::string> stages() const = 0;
    virtual MethodFrame processFrame(const RgbdFrame& frame) = 0;
    /// A frame whose stamp is not believed, which methods do not get: for those that judge stamps themselves.
    virtual void refused(const RgbdFrame& /*frame*/) {}

    /// Final poses once all frames are in, for methods that refine them later; none: those of processFrame().
    virtual std::optional<std::vector<StampedPose>> finalTrajectory() { return std::nullopt; }

    /// Milliseconds of work beside the frames (a mapping thread), and how often it was done.
    struct Background {
        std::string name;
        double mean_ms = 0;
        std::size_t count = 0;
    };
    virtual std::optional<Background> background() const { return std::nullopt; }

    /// Writes a 3-D scene of the map, when the method has one, and beside it what roevo-render makes a page
    /// of.
    /// @return whether it did
    virtual bool writeScene(const std::string& /*path*/) { return false; }
};

/// What a table has to say of a method, and how it is made.
struct MethodInfo {
    std::string name;            ///< as on the command line: "roevo-ba", "difodo-480", …
    std::string label;           ///< as in tables: "ROEVO TR+BA", "DIFODO 480x640", …
    std::string note;            ///< one sentence: what it is, and what is fair or weak about the comparison
    std::string unavailable;     ///< why this build cannot run it (a library lacks it); empty when it can
    std::optional<Mode> mode{};  ///< of one of ROEVO's own; none: another method
    std::string trajectory{};    ///< file with poses that another program made: not to be run; else empty
    /// @param options  of ROEVO, for its own modes and those that share its front end
    /// @throws std::invalid_argument for a camera that it cannot use
    std::function<std::unique_ptr<Method>(const PinholeCamera& camera, const OdometryOptions& options)>
        make{};  ///< none where it cannot be run
};

/// All methods that this program knows, in the order of its tables.
std::vector<MethodInfo> knownMethods();

/// @throws std::invalid_argument for an unknown or unavailable name, or a camera that it cannot use
std::unique_ptr<Method> makeMethod(const std::string& name, const PinholeCamera& camera,
                                   const OdometryOptions& options);

}  // namespace roevo
