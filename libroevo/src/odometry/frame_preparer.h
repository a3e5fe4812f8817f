#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "camera/undistorter.h"
#include "edges/edge_extractor.h"
#include "input_check.h"
#include "roevo/odometry.h"
#include "tracking/frame.h"

namespace roevo {

/// Keeps the longest edges, as they are and in their order, as long as their points are no more than these;
/// of equally long ones the first.
void keepLongest(OrganizedEdges& edges, std::size_t most_points);

/// What becomes of an image pair before anything is known of its pose.
struct PreparedFrame::Content {
    std::uint64_t by = 0;  ///< id of the preparer
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
        : camera_(camera), undistorter_(camera), extractor_(options.edges), levels_(options.coarse.levels) {}

    /// No other preparer has or had it: a new one may be where an old one was.
    std::uint64_t id() const { return id_; }

    /// @param images  are kept: nobody may write to them any more
    PreparedFrame::Content prepare(RgbdFrame images);

    /// From an image pair to organized edges (Sec. IV).
    /// @param frame  with its images; its other buffers are used again
    void findEdges(Frame& frame);

    /// A frame that is no longer used: its buffers are. From any thread.
    void giveBack(std::unique_ptr<Frame> frame);

  private:
    /// Forgets the depth of what is no scene. @return the scene in the ideal image; empty: all of it
    cv::Mat sceneOf(RgbdFrame& images) const;
    Fault faultOf(const RgbdFrame& images);
    std::unique_ptr<Frame> spare();

    static std::uint64_t nextId();

    std::uint64_t id_ = nextId();
    PinholeCamera camera_;
    Undistorter undistorter_;
    EdgeExtractor extractor_;
    int levels_;
    StampCheck stamps_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Frame>> spare_;
};

}  // namespace roevo
