#include "roevo/odometry.h"

#include <stdexcept>

#include "map_file.h"
#include "odometry_impl.h"
#include "stopwatch.h"

namespace roevo {
namespace {

std::string checkStart(const Pose& T_world_start) {
    if (!T_world_start.isFinite()) return "the start pose is not finite";
    if (!(T_world_start.rotation().norm() > 0.5))
        return "the start pose has no rotation: its quaternion is 0 0 0 0";
    return "";
}

}  // namespace

const char* version() {
    return ROEVO_VERSION;
}

PreparedFrame::PreparedFrame() = default;
PreparedFrame::~PreparedFrame() = default;
PreparedFrame::PreparedFrame(PreparedFrame&&) noexcept = default;
PreparedFrame& PreparedFrame::operator=(PreparedFrame&&) noexcept = default;

Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start)
    : Odometry(camera, options, T_world_start, nullptr) {}
Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start,
                   std::unique_ptr<Tracker> tracker) {
    if (const auto fault = camera.check(); !fault.empty()) throw std::invalid_argument(fault);
    if (const auto fault = checkOptions(options); !fault.empty()) throw std::invalid_argument(fault);
    if (const auto fault = checkStart(T_world_start); !fault.empty()) throw std::invalid_argument(fault);
    OdometryOptions own = options;
    // What the tracker of an experiment loses stays lost: what is found without it is not its merit
    if (tracker) own.loss.recognise = own.mapping.close_loops = false;
    if (!tracker) tracker = std::make_unique<Tracker>(camera, options);
    impl_ = std::make_unique<Impl>(camera, own, T_world_start, std::move(tracker));
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

int Odometry::loadMap(std::istream& in, MapUse use) {
    if (!impl_->world.empty() || impl_->world.loaded() > 0)
        throw std::logic_error("a map is loaded before the first frame, and once");
    const auto seconds_per_row = impl_->world.load(readMap(in), use == MapUse::kLocalise);
    if (seconds_per_row) impl_->motion.beginReadout(*seconds_per_row);
    return impl_->world.loaded();
}
int Odometry::saveMap(std::ostream& out) const {
    impl_->requireWhole();
    StoredMap map = impl_->world.map();
    const auto keyframes = static_cast<int>(map.graph.keyframes.size());
    writeMap(std::move(map), out);
    return keyframes;
}

FrameResult Odometry::processFrame(const RgbdFrame& images) {
    return processFrame(prepareFrame(images));
}
PreparedFrame Odometry::prepareFrame(const RgbdFrame& images) {
    const Stopwatch watch;
    RgbdFrame own{images.timestamp, images.grey.clone(), images.depth.clone(), images.colour.clone(),
                  images.mask.clone()};
    const double copied = watch.milliseconds();
    PreparedFrame prepared = prepareFrame(std::move(own));
    prepared.content_->milliseconds += copied;
    return prepared;
}
PreparedFrame Odometry::prepareFrame(RgbdFrame&& images) {
    PreparedFrame prepared;
    prepared.content_ = std::make_unique<PreparedFrame::Content>(impl_->preparer.prepare(std::move(images)));
    return prepared;
}
FrameResult Odometry::processFrame(PreparedFrame prepared) {
    if (!prepared.content_) throw std::logic_error("there is nothing in this prepared frame");
    if (prepared.content_->by != impl_->preparer.id())
        throw std::logic_error("this frame was prepared by another odometry");
    const Stopwatch watch;
    const double milliseconds = prepared.content_->milliseconds;
    FrameResult result = impl_->changing([&] { return impl_->processFrame(std::move(*prepared.content_)); });
    result.ms.total = milliseconds + watch.milliseconds();
    return result;
}

std::vector<MapRefusal> Odometry::refineAll() {
    return impl_->changing([&] { return impl_->world.refineAll(); });
}
std::vector<StampedPose> Odometry::trajectory() const {
    return impl_->world.finalTrajectory().frames(impl_->options.motion.smooth);
}
std::vector<StampedPose> Odometry::liveTrajectory() const {
    return impl_->world.trajectory().live();
}
Pose Odometry::motion(std::size_t from, std::size_t to) const {
    return impl_->world.trajectory().motion(from, to);
}
Matrix6d Odometry::motionCovariance(std::size_t from, std::size_t to) const {
    return impl_->world.motionCovariance(from, to);
}
std::vector<KeyframeInfo> Odometry::keyframes() const {
    return impl_->world.keyframes();
}
bool Odometry::isLocalised() const {
    return impl_->world.isLocalised();
}
EdgeMap Odometry::map() const {
    impl_->requireWhole();
    return impl_->world.fusedMap();
}
EdgeMap Odometry::keyframeEdges() const {
    impl_->requireWhole();
    return impl_->world.keyframeEdges();
}
std::vector<ColouredPoint> Odometry::semiDense() const {
    return impl_->world.semiDense();
}
double Odometry::readoutTime() const {
    return impl_->motion.secondsPerRow() * impl_->camera.height;
}
const PinholeCamera& Odometry::camera() const {
    return impl_->camera;
}
const OdometryOptions& Odometry::options() const {
    return impl_->options;
}

}  // namespace roevo
