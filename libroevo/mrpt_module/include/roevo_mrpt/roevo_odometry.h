#pragma once
#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DInterpolator.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDF.h>
#include <mrpt/system/COutputLogger.h>
#include <mrpt/system/CTimeLogger.h>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "roevo/odometry.h"
#include "roevo_mrpt/mrpt_compat.h"
#include "roevo_mrpt/simple_map.h"

namespace roevo {

/// roevo::Odometry with the habits of MRPT's mapping classes (the verbs of mrpt::slam::CMetricMapBuilder).
/// Poses are those of the robot (x forward, z up): each observation's sensorPose tells where its camera sits.
/// Not thread-safe. It can be neither copied nor moved: keep it by a std::unique_ptr where that is wanted.
class CRoevoOdometry : public mrpt::system::COutputLogger {
  public:
    /// The odometry's options as MRPT loads and saves them. Option "sensor.max_depth" is key `max_depth` of
    /// section [sensor], or of `[<section>.sensor]` when a section is given.
    struct TOptions : public mrpt::config::CLoadableOptions {
        OdometryOptions odometry;

        /// What is not there stays as it is.
        /// @throws std::runtime_error for an unknown key (naming the closest known one), a value out of
        /// range, and in or under a section that is given for whatever is no option.
        void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                const std::string& section) override;
        void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                              const std::string& section) const override;
        void dumpToTextStream(std::ostream& out) const override;
    };

    CRoevoOdometry();
    ~CRoevoOdometry() override;

    /// Takes effect at the next initialize() or first observation.
    TOptions options;

    /// Observations of this sensor are followed; empty: those of the first that gives a pose. Takes effect at
    /// the next initialize(), or before there is a pose.
    std::string sensor_label;

    /// Forgets everything but options, mask and sensor_label; the first pose that the robot has is x0's mean
    /// (default: the origin).
    /// @param initial_map  must be empty: a CSimpleMap does not tell what places look like (throws
    /// std::invalid_argument); see loadMapFromFile()
    void initialize(const mrpt::maps::CSimpleMap& initial_map = {},
                    const mrpt::poses::CPosePDF* x0 = nullptr);
    void initialize(const mrpt::poses::CPose3D& robot_pose);

    /// Begins with the map of an earlier run: poses are in its world from where the camera is recognised in
    /// it (odometry()->isLocalised()). To be called between initialize(), which forgets it, and the first
    /// observation that gives a pose.
    /// @param file  of saveMapToFile(); of roevo-odometry --map-out, too, whose worlds are not upright: they
    /// have the axes of a camera. Its contents are read at the first observation, and again
    /// where another sensor, or one that has moved, observes before there is a pose
    /// @throws std::runtime_error when the file cannot be read; std::logic_error once there is a pose
    void loadMapFromFile(const std::string& file, MapUse use = MapUse::kExtend);
    /// Writes a map for loadMapFromFile(), see Odometry::saveMap(): where the camera was not recognised in
    /// the map that was loaded, that alone. @return how many keyframes it has
    /// @throws std::runtime_error when there is none, or the file cannot be written; what was there is kept
    /// @throws std::logic_error when a map is used to localise only
    int saveMapToFile(const std::string& file) const;

    /// What is always in view and moves with the camera, such as the robot's own arm, is left out from the
    /// next observation on. @param mask  CV_8UC1 in the colour image's pixels, 0 there, see RgbdFrame::mask;
    /// empty: nothing
    void setMask(const cv::Mat& mask) { mask_ = mask.clone(); }

    /// Tracks one observation. Observations that cannot be used come back kRejected with a reason and are
    /// logged; so do those of another sensorLabel: this follows one camera.
    /// @return T_world_camera and its covariance are of the optical frame of the colour camera, in the
    /// robot's world.
    /// @throws std::runtime_error or std::invalid_argument as long as the first observation's intrinsics, an
    /// option or the map to begin with are unusable, and what mapping threw in its thread, e.g.
    /// std::bad_alloc
    FrameResult processObservation(const mrpt::obs::CObservation3DRangeScan& scan);

    /// Tracks the range images of the frame, those of other sensors are left out. The action is not used.
    /// @throws as processObservation(), with those that follow not tracked
    void processActionObservation(mrpt::obs::CActionCollection& action,
                                  mrpt::obs::CSensoryFrame& observations);

    /// The robot's latest pose with covariance (a CPose3DPDFGaussian). @return null before the first tracked
    /// observation
    mrpt::poses::CPose3DPDF::Ptr getCurrentPoseEstimation() const;

    /// How the robot moved between two observations that have poses, as both are known by now, with
    /// covariance: what a filter predicts with. Infinite where tracking was begun anew between them.
    /// @throws std::out_of_range for a result that was rejected
    mrpt::poses::CPose3DPDFGaussian getMotion(const FrameResult& from, const FrameResult& to) const;

    /// The robot's poses at all tracked observations.
    mrpt::poses::CPose3DInterpolator getTrajectory() const;

    /// When a recording ends, or whenever there is time: see roevo::Odometry::refineAll().
    /// @return keyframes that were left as they were, and why
    std::vector<MapRefusal> refineAll();

    /// The keyframes: robot pose, and the keyframe's edges as it saw them (pseudo-edges too) as a
    /// CObservationPointCloud of a CColouredPointsMap. Those of a map that was loaded have the sensor's pose
    /// of today, and no covariance.
    void getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out) const;
    unsigned int getCurrentlyBuiltMapSize() const;
    void saveCurrentMapToFile(const std::string& simplemap_file) const;

    /// The edges as coloured points in the world, without pseudo-edges; in mode ba fused over all keyframes.
    mrpt::maps::CColouredPointsMap::Ptr getMap() const;

    /// The surface next to the edges of all keyframes as coloured points in the world; empty when the option
    /// mapping.semi_dense_points is 0.
    mrpt::maps::CColouredPointsMap::Ptr getSemiDenseMap() const;

    /// Edges, surface, trajectory and keyframes, in mode ba also pseudo-edges and the co-visibility, see
    /// buildScene().
    compat::Scene::Ptr getScene() const;

    /// Time spent per stage.
    const mrpt::system::CTimeLogger& profiler() const { return profiler_; }

    /// The core, null before the first observation that gives a pose.
    const Odometry* odometry() const { return latest_ ? &*odometry_ : nullptr; }

  private:
    struct MapToLoad {
        std::string file;
        MapUse use = MapUse::kExtend;
    };
    bool isOther(const mrpt::obs::CObservation3DRangeScan& scan) const;
    void begin(const mrpt::obs::CObservation3DRangeScan& scan, const Pose& T_robot_camera);
    RgbdFrame convert(const mrpt::obs::CObservation3DRangeScan& scan);
    FrameResult track(const mrpt::obs::CObservation3DRangeScan& scan);
    void report(const FrameResult& result);

    Pose T_world_robot_start_ = Pose::Identity();
    std::optional<MapToLoad> map_to_load_;
    std::optional<Odometry> odometry_;
    std::string followed_;  // sensorLabel
    RobotContext context_;  // one mount unless the camera moves on the robot; covariances of frames
    std::optional<FrameResult> latest_;
    cv::Mat mask_;
    mrpt::system::CTimeLogger profiler_;
};

}  // namespace roevo
