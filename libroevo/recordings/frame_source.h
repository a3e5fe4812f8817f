#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recordings/input_choice.h"
#include "recordings/sensor_data.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/types.h"

namespace roevo {

/// One frame of an input, decoded, or the reason why it could not be.
struct SourceFrame {
    double timestamp = 0;                 ///< s
    RgbdFrame frame;                      ///< empty images when there is a fault
    std::string fault;                    ///< empty when decoding went well
    double ms_decode = 0;                 ///< reading and decoding
    double progress = 0;                  ///< share of the input that has been read, 0 to 1
    std::optional<Pose> camera_on_robot;  ///< T_robot_camera, for inputs that tell
    bool mounted = false;                 ///< the sensor sits elsewhere than on the robot's origin
};

/// Frames of a rawlog, of a bag or of a dataset folder, one after the other.
class FrameSource {
  public:
    virtual ~FrameSource() = default;

    /// The next frame, decoded; false at the end.
    virtual bool next(SourceFrame& frame) = 0;

    /// Leaves out one frame without decoding it; false at the end.
    virtual bool skip() = 0;

    /// No frame is left. Only openSource()'s can tell before next() does.
    virtual bool isAtEnd() const { return false; }

    virtual const PinholeCamera& camera() const = 0;
    virtual std::string kind() const = 0;          ///< "rawlog", "tum", …
    virtual std::string cameraSource() const = 0;  ///< where the intrinsics come from, in words
    /// The one that was chosen, which must be good, or found beside the input, where GroundTruth::note tells
    /// what is wrong with it; or empty.
    virtual GroundTruth groundTruth() const = 0;
    virtual std::vector<std::string> notes() const = 0;  ///< what was assumed or converted, a line each
    virtual std::size_t size() const = 0;                ///< number of frames, 0 when unknown
    virtual std::string warning() const = 0;  ///< once read: damage, things left out; one line or empty
};

/// Opens a rawlog, a bag or a dataset (folder).
/// @throws std::runtime_error in one line, also for a choice that is not for such an input: it is named as
/// the programs' option, such as --sensor-label (and is a UsageError to them)
std::unique_ptr<FrameSource> openSource(const std::string& input, const InputChoice& choice = {});

/// Decodes ahead in a thread of its own (programs/ahead.h), in order.
std::unique_ptr<FrameSource> prefetch(std::unique_ptr<FrameSource> source);

/// Leaves out the first frames, of a source of openSource(). @throws std::runtime_error when none is left,
/// which speaks of the programs' option --skip
/// @param input  name of the source for the message
void skipFrames(FrameSource& source, std::size_t count, const std::string& input);

/// Looks at the depth of the first frame that could be decoded, and of no other.
class DepthScaleCheck {
  public:
    /// What depthScaleFault() says of the frame if it is that one; else empty.
    std::string faultOf(const SourceFrame& frame);

    bool isDone() const { return done_; }  ///< such a frame was there

  private:
    bool done_ = false;
};

}  // namespace roevo
