#include "mapping/mapper.h"

#include <Eigen/LU>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

#include "stopwatch.h"

namespace roevo {
namespace {

constexpr std::size_t kMostWaiting = 8;  ///< keyframes that wait to be mapped

/// The keyframes' own edges, where tracking saw them.
class CollectingMapper : public Mapper {
  public:
    CollectingMapper(const PinholeCamera& camera, const SensorOptions& sensor)
        : camera_(camera), sensor_(sensor) {}

    void load(const std::vector<KeyframeInfo>& poses, std::vector<KeptKeyframe> keyframes) override;
    std::vector<KeptKeyframe> kept() override { return loaded_; }
    void insert(NewKeyframe fresh, double) override {
        const Eigen::Isometry3f T = fresh.T_world_camera.cast<float>();
        const EdgePoints3D& edges = fresh.keyframe.edges;
        add(fresh.keyframe.id, edges.image, fresh.colours,
            [&](std::size_t i) -> Eigen::Vector3f { return T * edges.points.at(i).cast<float>(); });
    }
    void correct(const Correction& correction) override {
        for (MapEdge& edge : map_)
            if (const auto found = correction.motions.find(edge.keyframe_id);
                found != correction.motions.end())
                for (Eigen::Vector3f& point : edge.points) point = found->second.cast<float>() * point;
    }
    std::vector<MapUpdate> due(double, double&) override { return {}; }
    const std::list<MapUpdate>& outstanding() override { return none_; }
    std::vector<MapUpdate> refineAll() override { return {}; }
    EdgeMap fusedMap() override { return map_; }
    EdgeMap keyframeEdges() override { return map_; }

  private:
    template <class PointOf>
    void add(int id, const OrganizedEdges& edges, const std::vector<Rgb>& colours, const PointOf& pointOf) {
        for (int e = 0; e < edges.numEdges(); ++e) {
            MapEdge edge;
            edge.keyframe_id = id;
            edge.cluster = static_cast<int>(map_.size());
            const auto [first, end] = edges.pointsOf(e);
            for (std::size_t i = first; i < end; ++i) edge.points.push_back(pointOf(i));
            edge.colours.assign(colours.data() + first, colours.data() + end);
            map_.push_back(std::move(edge));
        }
    }

    PinholeCamera camera_;
    SensorOptions sensor_;
    EdgeMap map_;
    std::vector<KeptKeyframe> loaded_;
    std::list<MapUpdate> none_;
};

void CollectingMapper::load(const std::vector<KeyframeInfo>& poses, std::vector<KeptKeyframe> keyframes) {
    loaded_ = std::move(keyframes);
    for (std::size_t k = 0; k < loaded_.size(); ++k) {
        const KeyframeEdges edges = loaded_[k].points.unpacked(camera_, sensor_);
        add(static_cast<int>(k), edges.image, edges.colours, [&](std::size_t i) -> Eigen::Vector3f {
            return (poses[k].T_world_camera * edges.points.at(i)).cast<float>();
        });
    }
}

/// Runs a LocalMapper beside the tracker. Keyframes are mapped in the order of insertion, one at a time, so
/// that the results do not depend on threads. All functions are for one caller's thread.
class RefiningMapper : public Mapper {
  public:
    RefiningMapper(const PinholeCamera& camera, const OdometryOptions& options)
        : camera_(camera), options_(options.mapping), mapper_(camera, options) {
        // Without a thread of its own it works when its results are asked for. Who does not wait for these
        // never asks
        if (threadCount(options.threads) > 1 || !options_.deterministic)
            worker_ = std::thread([this] { work(); });
    }
    ~RefiningMapper() override {
        if (!worker_.joinable()) return;
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            stop_ = true;
        }
        changed_.notify_all();
        worker_.join();
    }

    void load(const std::vector<KeyframeInfo>& poses, std::vector<KeptKeyframe> keyframes) override {
        for (std::size_t k = 0; k < keyframes.size(); ++k) mapper_.load(poses[k], std::move(keyframes[k]));
    }
    std::vector<KeptKeyframe> kept() override { return finish().kept(); }
    void insert(NewKeyframe fresh, double timestamp) override;
    void correct(const Correction& correction) override;
    std::vector<MapUpdate> due(double timestamp, double& waited_ms) override;
    const std::list<MapUpdate>& outstanding() override;
    std::vector<MapUpdate> refineAll() override;
    EdgeMap fusedMap() override { return finish().fusedMap(); }
    EdgeMap keyframeEdges() override { return finish().keyframeEdges(); }

  private:
    /// On the LocalMapper: a keyframe is inserted, and an update comes of that, or those that were are
    /// corrected. The update's room is there from the beginning: outside of jobs the worker needs no memory.
    struct Job {
        std::function<void(MapUpdate&)> run;
        std::list<MapUpdate> update;  ///< one or none
    };
    using Lock = std::unique_lock<std::mutex>;
    void work();
    void runNext(Lock& lock);
    template <class Condition>
    void waitFor(Lock& lock, const Condition& condition);
    void push(Job job);
    bool isIdle() const { return jobs_.empty() && !busy_; }
    LocalMapper& finish();

    PinholeCamera camera_;
    MappingOptions options_;
    std::deque<double> due_;  // times from which on the updates take effect, s, in order

    LocalMapper mapper_;  // touched by the worker only, or by the caller while the worker is idle
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    std::list<MapUpdate> updates_;
    std::exception_ptr failure_;
    bool busy_ = false, stop_ = false;
    std::thread worker_;  // last: it uses all of the above
};

void RefiningMapper::insert(NewKeyframe fresh, double timestamp) {
    MapKeyframe keyframe = toMapKeyframe(fresh.keyframe, fresh.colours, camera_, options_.max_points);
    keyframe.T_world_camera = fresh.T_world_camera;
    keyframe.parent = fresh.tracked.keyframe;
    keyframe.T_parent_camera = fresh.tracked.T_keyframe_camera;
    if (fresh.tracked.keyframe < 0)
        keyframe.track = fresh.keyframe.id;
    else
        keyframe.parent_information = fresh.tracked.covariance().inverse();
    int previous = -1;
    std::vector<float> found;
    RowMotion rows;
    if (fresh.previous != nullptr) {
        previous = fresh.previous->id;
        found = fresh.previous->foundShares();
        rows = fresh.previous->row_motion;
    }
    due_.push_back(timestamp + (options_.latency - 0.5) / kFrameRate);
    auto run = [this, keyframe = std::move(keyframe), previous, found = std::move(found), rows,
                seconds_per_row = fresh.seconds_per_row](MapUpdate& update) mutable {
        const Stopwatch watch;
        const CpuStopwatch cpu_watch;
        mapper_.learnOf(previous, std::move(found), rows);
        mapper_.setReadout(seconds_per_row);
        update = mapper_.insert(std::move(keyframe));
        update.milliseconds = watch.milliseconds();
        update.cpu_milliseconds = cpu_watch.milliseconds();
    };
    push({std::move(run), std::list<MapUpdate>(1)});
}

void RefiningMapper::correct(const Correction& correction) {
    push({[this, correction](MapUpdate&) { mapper_.correct(correction); }, {}});
}

void RefiningMapper::push(Job job) {
    Lock lock(mutex_);
    waitFor(lock, [&] { return jobs_.size() < kMostWaiting; });
    jobs_.push_back(std::move(job));
    changed_.notify_all();
}

std::vector<MapUpdate> RefiningMapper::due(double timestamp, double& waited_ms) {
    std::vector<MapUpdate> updates;
    Lock lock(mutex_);
    while (!due_.empty()) {
        if (options_.deterministic ? due_.front() > timestamp : updates_.empty() && !failure_) break;
        const Stopwatch watch;
        // None comes where memory ran out between a promise and its job
        waitFor(lock, [&] { return !updates_.empty() || isIdle(); });
        waited_ms += watch.milliseconds();
        if (failure_) std::rethrow_exception(failure_);
        if (updates_.empty()) break;
        due_.pop_front();
        updates.push_back(std::move(updates_.front()));
        updates_.pop_front();
    }
    return updates;
}

const std::list<MapUpdate>& RefiningMapper::outstanding() {
    Lock lock(mutex_);
    waitFor(lock, [&] { return isIdle(); });
    return updates_;  // which the worker leaves alone until there is a job again
}

std::vector<MapUpdate> RefiningMapper::refineAll() {
    LocalMapper& mapper = finish();
    std::vector<MapUpdate> updates(std::make_move_iterator(updates_.begin()),
                                   std::make_move_iterator(updates_.end()));
    updates_.clear();
    due_.clear();
    updates.push_back(mapper.refineAll());
    return updates;
}

void RefiningMapper::work() {
    Lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
        if (stop_) return;
        runNext(lock);
    }
}

/// Until the worker has come so far; without one, by doing its work.
template <class Condition>
void RefiningMapper::waitFor(Lock& lock, const Condition& condition) {
    while (!condition()) {
        if (worker_.joinable())
            changed_.wait(lock);
        else
            runNext(lock);
    }
}

/// @param lock  let go meanwhile
void RefiningMapper::runNext(Lock& lock) {
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    std::exception_ptr failure = failure_;  // what it left half done is not gone on with
    lock.unlock();
    try {
        MapUpdate none;
        if (!failure) job.run(job.update.empty() ? none : job.update.front());
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    failure_ = failure;
    if (!failure_) updates_.splice(updates_.end(), job.update);
    changed_.notify_all();
}

LocalMapper& RefiningMapper::finish() {
    Lock lock(mutex_);
    waitFor(lock, [&] { return isIdle(); });
    if (failure_) std::rethrow_exception(failure_);
    return mapper_;
}

}  // namespace

std::unique_ptr<Mapper> makeMapper(const PinholeCamera& camera, const OdometryOptions& options) {
    if (options.mode == Mode::kBundleAdjustment) return std::make_unique<RefiningMapper>(camera, options);
    return std::make_unique<CollectingMapper>(camera, options.sensor);
}

}  // namespace roevo
