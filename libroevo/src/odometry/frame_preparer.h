#pragma once
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include "edges/organized_edges.h"
#include "front_end.h"
#include "input_check.h"
#include "roevo/odometry.h"

namespace roevo {

/// Keeps the longest edges, as they are and in their order, as long as their points are no more than these;
/// of equally long ones the first.
void keepLongest(OrganizedEdges& edges, std::size_t most_points);

class FramePreparer;

/// What becomes of an image pair before anything is known of its pose.
struct PreparedFrame::Content {
    const FramePreparer* by = nullptr;
    double timestamp = 0;
    Fault fault;                   ///< why it cannot be processed; then there is no frame
    std::unique_ptr<Frame> frame;  ///< with its edges
    double milliseconds = 0;
};

/// Checks frames and finds their edges. Knows nothing of tracking, so that it may be frames ahead of it, in
/// another thread; that thread alone calls prepare().
class FramePreparer {
  public:
    /// @param camera   with its lens
    /// @param options  scaled to the camera
    FramePreparer(const PinholeCamera& camera, const OdometryOptions& options)
        : camera_(camera), front_end_(camera, options) {}

    PreparedFrame::Content prepare(const RgbdFrame& images);  ///< copies them
    PreparedFrame::Content prepare(RgbdFrame&& images);       ///< keeps them

    /// A frame that is no longer used: its buffers are. From any thread.
    void giveBack(std::unique_ptr<Frame> frame);

  private:
    /// @param take  puts the images into a frame
    template <typename Take>
    PreparedFrame::Content prepare(const RgbdFrame& images, const Take& take);
    Fault faultOf(const RgbdFrame& images);
    std::unique_ptr<Frame> spare();

    PinholeCamera camera_;
    FrontEnd front_end_;
    double last_timestamp_ = -std::numeric_limits<double>::infinity();  ///< of those without a fault
    LeapCheck leaps_;
    bool keeps_ = false;  ///< images that others brought are in the frames
    std::mutex mutex_;
    std::vector<std::unique_ptr<Frame>> spare_;
};

}  // namespace roevo
