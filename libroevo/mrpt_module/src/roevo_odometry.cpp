#include "roevo_mrpt/roevo_odometry.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "coloured_points.h"
#include "input/excerpt.h"
#include "input/regular_file.h"
#include "roevo_mrpt/map_file.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/scene_builder.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

using mrpt::maps::CColouredPointsMap;
using mrpt::obs::CObservation3DRangeScan;

/// In one line. MRPT's own faults have a head, and a call stack after the message.
std::string reasonOf(const std::exception& fault) {
    const std::string text = fault.what(), mark = "Message:";
    const std::size_t found = text.find(mark);
    return firstLine(found == std::string::npos ? text : text.substr(found + mark.size()));
}

}  // namespace

CRoevoOdometry::CRoevoOdometry()
    : mrpt::system::COutputLogger("CRoevoOdometry"), profiler_(true, "CRoevoOdometry") {}

CRoevoOdometry::~CRoevoOdometry() {
    profiler_.clear(true);  // MRPT prints the statistics on destruction otherwise; ask profiler() for them
}

void CRoevoOdometry::initialize(const mrpt::maps::CSimpleMap& initial_map, const mrpt::poses::CPosePDF* x0) {
    if (!initial_map.empty())
        throw std::invalid_argument(
            "a CSimpleMap does not tell what places look like: pass an empty one, and see loadMapFromFile()");
    initialize(x0 != nullptr ? mrpt::poses::CPose3D(x0->getMeanVal()) : mrpt::poses::CPose3D());
}

void CRoevoOdometry::initialize(const mrpt::poses::CPose3D& robot_pose) {
    T_world_robot_start_ = toEigen(robot_pose);
    map_to_load_.reset();
    odometry_.reset();
    context_ = {};
    latest_.reset();
    profiler_.clear();
}

void CRoevoOdometry::loadMapFromFile(const std::string& file, MapUse use) {
    if (latest_) throw std::logic_error("a map is loaded before the first observation that gives a pose");
    requireRegularInput(file);
    if (!std::ifstream(file)) throw std::runtime_error("cannot read " + file + ": " + std::strerror(errno));
    map_to_load_ = {file, use};
    odometry_.reset();
}

int CRoevoOdometry::saveMapToFile(const std::string& file) const {
    if (!odometry_) throw std::runtime_error("cannot write " + file + ": there is no keyframe");
    return saveMapFile(*odometry_, file);
}

void CRoevoOdometry::begin(const CObservation3DRangeScan& scan, const Pose& T_robot_camera) {
    Odometry fresh(colourCameraOf(scan), options.odometry, T_world_robot_start_ * T_robot_camera);
    if (map_to_load_) {
        const mrpt::system::CTimeLoggerEntry entry(profiler_, "load");
        const int keyframes = loadMapFile(map_to_load_->file, fresh, map_to_load_->use);
        logFmt(mrpt::system::LVL_INFO, "%s: a map of %d keyframes", map_to_load_->file.c_str(), keyframes);
    }
    followed_ = scan.sensorLabel;
    context_.mounts = {{fromMrptTime(scan.timestamp), T_robot_camera}};
    odometry_ = std::move(fresh);
}

bool CRoevoOdometry::isOther(const CObservation3DRangeScan& scan) const {
    if (latest_) return scan.sensorLabel != followed_;
    return !sensor_label.empty() && scan.sensorLabel != sensor_label;
}

RgbdFrame CRoevoOdometry::convert(const CObservation3DRangeScan& scan) {
    const mrpt::system::CTimeLoggerEntry entry(profiler_, "convert");
    // In a CRawlog that was read, what is in files is not loaded; what is, would stay in memory
    const bool to_load = scan.rangeImage_isExternallyStored() && scan.rangeImage.rows() == 0;
    const struct Unload {
        const CObservation3DRangeScan* scan;
        ~Unload() {
            if (scan != nullptr) scan->unload();
        }
    } afterwards{to_load ? &scan : nullptr};
    if (to_load) scan.load();
    RgbdFrame frame = toRgbdFrame(scan);
    frame.mask = mask_;
    return frame;
}

FrameResult CRoevoOdometry::track(const CObservation3DRangeScan& scan) {
    FrameResult result;
    result.timestamp = fromMrptTime(scan.timestamp);
    const auto camera = [&] { return colourCameraOf(scan); };
    if (!latest_ && !isOther(scan)) camera();  // without intrinsics nothing can begin
    RgbdFrame frame;
    Pose T_robot_camera;
    try {
        if (isOther(scan))
            throw std::runtime_error("of sensor '" + excerpt(scan.sensorLabel) +
                                     "', this odometry follows '" +
                                     excerpt(latest_ ? followed_ : sensor_label) + "'");
        if (latest_ && !camera().seesAs(odometry_->camera()))
            throw std::runtime_error("the camera's intrinsics changed");
        frame = convert(scan);  // refuses poses that are none
        T_robot_camera = cameraOnRobot(scan);
    } catch (const std::exception& fault) {  // MRPT's are of many kinds
        result.reason = reasonOf(fault);
        return result;
    }
    // What was rejected until now does not count: the robot begins where this one sees from
    const auto as_before = [&] {
        return odometry_ && scan.sensorLabel == followed_ && camera().seesAs(odometry_->camera()) &&
               context_.mounts.rbegin()->second.isApprox(T_robot_camera);
    };
    if (!latest_ && !as_before()) begin(scan, T_robot_camera);
    const mrpt::system::CTimeLoggerEntry entry(profiler_, "track");
    result = odometry_->processFrame(frame);
    if (result.hasPose() && !context_.mounts.rbegin()->second.isApprox(T_robot_camera))
        context_.mounts[result.timestamp] = T_robot_camera;
    return result;
}

FrameResult CRoevoOdometry::processObservation(const CObservation3DRangeScan& scan) {
    const FrameResult result = track(scan);
    if (result.hasPose()) {
        latest_ = result;
        // Of every frame: a later one may make it the keyframe
        context_.covariances[result.timestamp] = result.covariance;
        context_.stamps[result.timestamp] = scan.timestamp;
    }
    report(result);
    return result;
}

void CRoevoOdometry::report(const FrameResult& result) {
    const bool well = result.status == FrameStatus::kOk || result.status == FrameStatus::kInitialised;
    logFmt(well ? mrpt::system::LVL_DEBUG : mrpt::system::LVL_WARN, "%.6f %s%s%s", result.timestamp,
           toString(result.status), result.reason.empty() ? "" : ": ", result.reason.c_str());
}

void CRoevoOdometry::processActionObservation(mrpt::obs::CActionCollection&,
                                              mrpt::obs::CSensoryFrame& observations) {
    for (const auto& observation : observations) {
        const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation);
        if (!scan) continue;
        if (isOther(*scan))
            logFmt(mrpt::system::LVL_DEBUG, "left out: of sensor '%s'", excerpt(scan->sensorLabel).c_str());
        else
            processObservation(*scan);
    }
}

mrpt::poses::CPose3DPDF::Ptr CRoevoOdometry::getCurrentPoseEstimation() const {
    if (!latest_) return nullptr;
    return mrpt::poses::CPose3DPDFGaussian::Create(toMrptGaussian(
        latest_->T_world_camera, latest_->covariance, context_.mountAt(latest_->timestamp).inverse()));
}

mrpt::poses::CPose3DPDFGaussian CRoevoOdometry::getMotion(const FrameResult& from,
                                                          const FrameResult& to) const {
    if (!latest_ || from.index < 0 || to.index < 0)
        throw std::out_of_range("there is no motion between observations that have no poses");
    const auto first = static_cast<std::size_t>(from.index), last = static_cast<std::size_t>(to.index);
    return robotMotion(odometry_->motion(first, last), odometry_->motionCovariance(first, last),
                       context_.mountAt(from.timestamp), context_.mountAt(to.timestamp));
}

std::vector<MapRefusal> CRoevoOdometry::refineAll() {
    if (!latest_) return {};
    std::vector<MapRefusal> refusals = odometry_->refineAll();
    latest_->T_world_camera = odometry_->trajectory().back().T_world_camera;
    return refusals;
}

mrpt::poses::CPose3DInterpolator CRoevoOdometry::getTrajectory() const {
    mrpt::poses::CPose3DInterpolator out;
    if (!odometry_) return out;
    for (const StampedPose& pose : odometry_->trajectory())
        out.insert(context_.stampOf(pose.timestamp),
                   toMrpt(pose.T_world_camera * context_.mountAt(pose.timestamp).inverse()));
    return out;
}

void CRoevoOdometry::getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out) const {
    out.clear();
    if (odometry_) buildSimpleMap(odometry_->keyframes(), odometry_->keyframeEdges(), context_, out);
}

unsigned int CRoevoOdometry::getCurrentlyBuiltMapSize() const {
    return odometry_ ? static_cast<unsigned int>(odometry_->keyframes().size()) : 0;
}

void CRoevoOdometry::saveCurrentMapToFile(const std::string& simplemap_file) const {
    mrpt::maps::CSimpleMap map;
    getCurrentlyBuiltMap(map);
    saveSimpleMap(simplemap_file, map);
}

CColouredPointsMap::Ptr CRoevoOdometry::getMap() const {
    auto out = CColouredPointsMap::Create();
    if (odometry_)
        for (const MapEdge& edge : odometry_->map())
            if (!isPseudo(edge.verdict)) appendEdge(*out, edge, Pose::Identity());
    return out;
}

CColouredPointsMap::Ptr CRoevoOdometry::getSemiDenseMap() const {
    auto out = CColouredPointsMap::Create();
    if (!odometry_) return out;
    const auto points = odometry_->semiDense();
    out->reserve(points.size());
    for (const ColouredPoint& point : points) append(*out, point.position, point.colour);
    return out;
}

compat::Scene::Ptr CRoevoOdometry::getScene() const {
    SceneContent content;
    content.T_scene_world = Pose::Identity();  // the robot's world has z up already
    if (odometry_) {
        content.map = odometry_->map();
        // The other modes do not tell which edges are the same
        if (odometry_->options().mode == Mode::kBundleAdjustment)
            content.keyframe_edges = odometry_->keyframeEdges();
        content.semi_dense = odometry_->semiDense();
        content.trajectory = odometry_->trajectory();
        content.keyframes = odometry_->keyframes();
        content.camera = odometry_->camera();
    }
    return buildScene(content);
}

}  // namespace roevo
