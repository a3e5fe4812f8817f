#pragma once
#include <iosfwd>
#include <memory>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/edge_map.h"
#include "roevo/frame_result.h"
#include "roevo/options.h"

namespace roevo {

class Tracker;

/// Of the library that runs, such as "0.1.0".
const char* version();

/// What becomes of a map that is loaded.
enum class MapUse {
    kExtend,   ///< keyframes are added to it, and loops may move it
    kLocalise  ///< it stays as it is
};

/// A frame whose edges have been found, on its way from Odometry::prepareFrame() to processFrame().
class PreparedFrame {
  public:
    PreparedFrame();  ///< nothing
    ~PreparedFrame();
    PreparedFrame(PreparedFrame&&) noexcept;
    PreparedFrame& operator=(PreparedFrame&&) noexcept;

    struct Content;

  private:
    friend class Odometry;
    std::unique_ptr<Content> content_;
};

/// RGB-D visual odometry from organized edges (Liu et al., ROEVO). Feed frames in time order; not
/// thread-safe, but for prepareFrame(). What tells of the whole recording (trajectory, keyframes, map, edges,
/// surface) changes no result, but waits for the mapping thread and takes time that grows with the recording:
/// use FrameResult for every frame. With mapping in a thread (options().threads) it cannot be used
/// or destroyed in a process that fork() made. One that was moved from can only be destroyed or assigned to.
///
/// Memory may run out, in the caller's thread or in mapping's: processFrame() or refineAll() throws
/// std::bad_alloc then, or whatever else was thrown, and so do both from then on, and saveMap(), map() and
/// keyframeEdges(). Poses, keyframes and surface are given as far as they had come.
class Odometry {
  public:
    /// @throws std::invalid_argument when the camera, an option or the start pose is unusable (one line that
    /// names it); std::system_error when the mapping thread cannot be started
    /// @param T_world_start  of the first frame. Map and surface are of floats: 10 km from the origin they are
    /// right to 1 mm, 4000 km away to 0.25 m, while poses are not the worse for it
    Odometry(const PinholeCamera& camera, const OdometryOptions& options,
             const Pose& T_world_start = Pose::Identity());
    /// With another tracker, for experiments: frames that it loses are not looked up among the keyframes, and
    /// no loops are closed; options() says so.
    Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start,
             std::unique_ptr<Tracker> tracker);
    ~Odometry();
    Odometry(Odometry&&) noexcept;
    Odometry& operator=(Odometry&&) noexcept;

    /// Begins with the map of an earlier recording, before the first frame. The first frame that shows one of
    /// its places, or else the first keyframe, brings the recording into the map's world; until then it is in
    /// a world of its own, which begins at T_world_start (FrameResult::found_at and joined_at tell when;
    /// keyframes of the map are the first of keyframes()). The stream must end with the map.
    /// @return how many keyframes the map has
    /// @throws std::runtime_error in one line: no map, of another version, incomplete, damaged, of another
    /// camera, or recognising is off (options().loss). The odometry is then as it was
    /// @throws std::logic_error when there is a frame or a map already
    int loadMap(std::istream& in, MapUse use = MapUse::kExtend);
    /// Writes a map that loadMap() reads: the keyframes with their edges, places and surfaces, those of the
    /// map that was loaded and those that were joined to it; without one, those of the longest piece. Waits
    /// for what is still being mapped. Whether all was written is in the stream's state.
    /// @return how many keyframes the map has
    /// @throws std::runtime_error when there is no keyframe, or places are not remembered (loss.recognise and
    /// mapping.close_loops are off)
    /// @throws std::logic_error when a map is used to localise only
    int saveMap(std::ostream& out) const;

    /// Tracks one frame. Never throws for bad frames: they come back kRejected with a reason. What it does
    /// throw, see above, ends the odometry.
    [[nodiscard]] FrameResult processFrame(const RgbdFrame& frame);

    /// The two halves of processFrame(), for a pipeline of two threads: what needs no pose, and the rest. One
    /// thread at a time may prepare the next frames while another one uses everything else. Frames are
    /// prepared in time order and processed in the same order, each once; what comes out is the same to the
    /// bit. FrameResult::ms counts both halves.
    [[nodiscard]] PreparedFrame prepareFrame(const RgbdFrame& frame);
    /// The same without a copy: keeps the images, which nobody may write to any more.
    [[nodiscard]] PreparedFrame prepareFrame(RgbdFrame&& frame);
    /// @throws std::logic_error where there is nothing in it, or another odometry prepared it
    [[nodiscard]] FrameResult processFrame(PreparedFrame frame);

    /// Brings the map into agreement, at the end of a recording or whenever there is time: what is still
    /// being mapped takes effect, and in mode ba all keyframes are refined together (mapping.final_rounds).
    /// Frames may follow. Covariances stay as they were. It takes seconds where hundreds of keyframes see the
    /// same room.
    /// @return keyframes that were left as they were, and why
    /// @throws what mapping threw in its thread, e.g. std::bad_alloc
    std::vector<MapRefusal> refineAll();

    /// Final poses of all frames that have one, in time order, unique stamps.
    std::vector<StampedPose> trajectory() const;
    /// The poses as they were known when their frames were processed.
    std::vector<StampedPose> liveTrajectory() const;

    /// Covariance of the motion between two frames, given by FrameResult::index: of T_from_to, position (m),
    /// then orientation (rad, R <- R exp(phi)), along the axes of the second camera. Infinite where tracking
    /// was begun anew between them and nothing has brought the two together.
    /// @throws std::out_of_range where there is no such frame
    Matrix6d motionCovariance(std::size_t from, std::size_t to) const;
    /// T_from_to of the same frames as it was tracked and the map has it by now, neither smoothed nor bridged
    /// as in trajectory(), which errs less. Where its covariance is infinite it means nothing.
    /// Live poses from before and after the map moved do not make a motion of the camera.
    /// @throws std::out_of_range where there is no such frame
    Pose motion(std::size_t from, std::size_t to) const;

    /// Those of a map that was loaded come first, once the camera was recognised in it.
    std::vector<KeyframeInfo> keyframes() const;
    /// Whether all is in the world of a map that was loaded: the camera was recognised in it.
    bool isLocalised() const;

    /// The 3-D edges in the world: fused over all keyframes in mode ba, else the keyframes' own. Those of
    /// tracks that were not joined (KeyframeInfo::track) are where these were begun.
    EdgeMap map() const;
    /// The edges of each keyframe as it saw them, with the cluster that they belong to.
    EdgeMap keyframeEdges() const;
    /// The surface next to the edges of all keyframes, in the world at their final poses, coloured; one
    /// keyframe after the other. Empty when mapping.semi_dense_points is 0.
    std::vector<ColouredPoint> semiDense() const;

    /// Read-out time of the rolling shutter as learned so far or as set, s.
    double readoutTime() const;

    const PinholeCamera& camera() const;  ///< as given (with distortion)
    const OdometryOptions& options() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo
