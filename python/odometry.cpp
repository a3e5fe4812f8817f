#include "roevo/odometry.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>

#include <memory>
#include <mutex>

#include "bindings.h"
#include "images.h"
#include "roevo_mrpt/map_file.h"

namespace py = pybind11;

namespace roevo::python {

Pose toPose(const Eigen::MatrixXd& matrix, const std::string& name) {
    if (matrix.rows() != 4 || matrix.cols() != 4) throw std::invalid_argument(name + " must be 4 x 4");
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    const bool rigid = matrix.allFinite() && (rotation * rotation.transpose()).isIdentity(1e-4) &&
                       rotation.determinant() > 0 &&
                       matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-9);
    if (!rigid) throw std::invalid_argument(name + " is no rigid motion (rotation, translation, 0 0 0 1)");
    return Pose(Eigen::Quaterniond(rotation), matrix.topRightCorner<3, 1>());
}

namespace {

/// N x 8: timestamp tx ty tz qx qy qz qw, with qw >= 0.
py::array_t<double> toArray(const std::vector<StampedPose>& poses) {
    py::array_t<double> out({static_cast<py::ssize_t>(poses.size()), py::ssize_t{8}});
    double* to = out.mutable_data();
    for (const StampedPose& pose : poses) {
        const Eigen::Vector3d& t = pose.T_world_camera.translation();
        Eigen::Quaterniond q(pose.T_world_camera.linear());
        if (q.w() < 0) q.coeffs() *= -1;
        for (const double value : {pose.timestamp, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
            *to++ = value;
    }
    return out;
}

/// N x 3 of anything that has three values by index.
template <class Value, class Items, class Part>
py::array_t<Value> rows(const Items& items, const Part& part) {
    py::array_t<Value> out({static_cast<py::ssize_t>(items.size()), py::ssize_t{3}});
    Value* to = out.mutable_data();
    for (const auto& item : items)
        for (int i = 0; i < 3; ++i) *to++ = part(item)[i];
    return out;
}
template <class Value, class Items>
py::array_t<Value> rows(const Items& items) {
    return rows<Value>(
        items, [](const auto& item) -> const auto& { return item; });
}

/// Lets other threads run Python. A thread that is in here when Python ends is ended by an unwinding as it
/// comes back, which pybind11's own (gil_scoped_release) makes the end of the program.
class WithoutPython {
  public:
    WithoutPython() = default;
    ~WithoutPython() noexcept(false) { PyEval_RestoreThread(state_); }
    WithoutPython(const WithoutPython&) = delete;
    WithoutPython& operator=(const WithoutPython&) = delete;

  private:
    PyThreadState* const state_ = PyEval_SaveThread();
};

/// The odometry for several Python threads: one at a time works with it, and lets the others run Python
/// meanwhile.
class Session {
    template <class Work>
    auto alone(const Work& work) {
        if (getpid() != process_)
            throw std::runtime_error("this Odometry was made before fork(): make another in this process");
        const WithoutPython released;
        const std::lock_guard<std::mutex> lock(mutex_);
        return work(*odometry_);
    }

  public:
    Session(const PinholeCamera& camera, const py::object& options, const Eigen::MatrixXd& T_world_start)
        : odometry_(std::make_unique<Odometry>(camera, toOptions(options),
                                               toPose(T_world_start, "T_world_start"))) {}
    ~Session() {
        // The threads that it would wait for are not in this process
        if (getpid() != process_) (void)odometry_.release();
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const Odometry& odometry() const { return *odometry_; }  // what never changes of it

    FrameResult process(const py::object& colour, const py::object& depth, const py::object& stamp,
                        const py::object& depth_scale, bool bgr, const py::object& mask) {
        const RgbdFrame frame = toFrame(colour, depth, stamp, depth_scale, bgr, mask, odometry_->camera());
        return alone([&](Odometry& odometry) { return odometry.processFrame(frame); });
    }

    std::vector<std::string> refineAll() {
        std::vector<std::string> refusals;
        for (const MapRefusal& refusal : alone([](Odometry& odometry) { return odometry.refineAll(); }))
            refusals.push_back(describe(refusal));
        return refusals;
    }

    int loadMap(const std::filesystem::path& file, bool localise_only) {
        requireReadable(file);
        return alone([&](Odometry& odometry) {
            return loadMapFile(file.string(), odometry, localise_only ? MapUse::kLocalise : MapUse::kExtend);
        });
    }

    int saveMap(const std::filesystem::path& file) {
        int keyframes = 0;
        saveTo(file, [&](const std::string& name) {
            keyframes = alone([&](const Odometry& odometry) { return saveMapFile(odometry, name); });
        });
        return keyframes;
    }

    /// What a constant function of the odometry gives.
    template <class Value, class... Arguments>
    Value get(Value (Odometry::*function)(Arguments...) const, Arguments... arguments) {
        return alone([&](const Odometry& odometry) { return (odometry.*function)(arguments...); });
    }

  private:
    std::mutex mutex_;
    std::unique_ptr<Odometry> odometry_;
    const pid_t process_ = getpid();
};

void addResult(py::module_& module) {
    py::class_<FrameResult>(module, "FrameResult", "What became of one frame.")
        .def_readonly("timestamp", &FrameResult::timestamp, "seconds")
        .def_readonly("index", &FrameResult::index, "place in live_trajectory(); -1 when rejected")
        .def_property_readonly(
            "status", [](const FrameResult& self) { return toString(self.status); },
            "\"ok\", \"initialised\" (a new beginning), \"predicted\" or \"lost\" (not tracked), "
            "\"rejected\" "
            "(bad input)")
        .def_readonly("reason", &FrameResult::reason, "in words; empty when all is well")
        .def_property_readonly(
            "pose",
            [](const FrameResult& self) -> py::object {
                if (!self.hasPose()) return py::none();
                return py::cast(self.T_world_camera.matrix());
            },
            "T_world_camera as a 4 x 4 array; None when rejected")
        .def_property_readonly(
            "covariance",
            [](const FrameResult& self) -> py::object {
                if (!self.hasPose()) return py::none();
                return py::cast(self.covariance);
            },
            "6 x 6: position (m), then orientation (rad, R <- exp(phi) R), along the world's axes; None when "
            "rejected")
        .def_readonly("keyframe", &FrameResult::keyframe,
                      "id of the keyframe that the pose is relative to; -1 when rejected")
        .def_readonly("new_keyframe", &FrameResult::new_keyframe, "whether it brought a new keyframe")
        .def_readonly("num_edges", &FrameResult::num_edges, "organized edges in the frame")
        .def_readonly("num_points", &FrameResult::num_points, "points of its edges")
        .def_readonly("inliers", &FrameResult::inliers,
                      "edge points that passed the chi-square test (mode ct: that were associated)")
        .def_readonly("matched_ratio", &FrameResult::matched_ratio,
                      "share of the keyframe's visible edges that were associated, 0 to 1")
        .def_readonly("found_at", &FrameResult::found_at,
                      "keyframe that a lost camera was recognised by, or -1")
        .def_readonly("joined_at", &FrameResult::joined_at,
                      "keyframe of another track that it was joined to, or -1")
        .def_readonly("closed_at", &FrameResult::closed_at, "keyframe that a loop was closed to, or -1")
        .def_readonly("map_correction", &FrameResult::map_correction,
                      "metres: how far the map, or a place that was recognised, moved the camera before this "
                      "pose was known; poses before and after differ by it without any motion")
        .def_readonly("map_turn", &FrameResult::map_turn, "radians: how far it turned it, likewise")
        .def_property_readonly(
            "milliseconds", [](const FrameResult& self) { return self.ms.total; }, "that the frame took")
        .def("__repr__", [](const FrameResult& self) {
            const std::string reason = self.reason.empty() ? "" : ": " + self.reason;
            return "<roevo.FrameResult " + std::string(py::str(py::float_(self.timestamp))) + " " +
                   toString(self.status) + reason + ">";
        });
}

void addMapParts(py::module_& module) {
    py::class_<MapEdge>(module, "MapEdge", "An organized edge of the map.")
        .def_property_readonly(
            "points", [](const MapEdge& self) { return rows<float>(self.points); },
            "N x 3 float32, in order along the edge, world, metres")
        .def_property_readonly(
            "colours", [](const MapEdge& self) { return rows<std::uint8_t>(self.colours); },
            "N x 3 uint8, RGB")
        .def_readonly("keyframe", &MapEdge::keyframe_id, "keyframe whose edge its first point is of")
        .def_readonly("cluster", &MapEdge::cluster, "the same for edges of keyframes that show the same edge")
        .def_readonly("views", &MapEdge::views, "keyframes that see it")
        .def_property_readonly(
            "verdict", [](const MapEdge& self) { return toString(self.verdict); },
            "\"unconfirmed\", \"true\", or \"pseudo: \" and why")
        .def_property_readonly(
            "is_pseudo", [](const MapEdge& self) { return isPseudo(self.verdict); },
            "whether it belongs to no surface: a moving shadow, a border")
        .def_readonly("confidence", &MapEdge::confidence, "0 to 1");
    py::class_<KeyframeInfo>(module, "Keyframe", "A keyframe, with its pose as it is known by now.")
        .def_readonly("id", &KeyframeInfo::id,
                      "as FrameResult.keyframe; those of a map that was loaded come first")
        .def_readonly("timestamp", &KeyframeInfo::timestamp, "seconds")
        .def_readonly("track", &KeyframeInfo::track,
                      "the first keyframe of its track; what is between tracks means nothing")
        .def_property_readonly(
            "pose", [](const KeyframeInfo& self) -> Eigen::Matrix4d { return self.T_world_camera.matrix(); },
            "T_world_camera, 4 x 4");
}

/// Whatever it is: the odometry says which frames there are.
std::size_t toIndex(py::ssize_t index) {
    return static_cast<std::size_t>(index);
}

void addPoses(py::class_<Session>& session) {
    session
        .def(
            "trajectory", [](Session& self) { return toArray(self.get(&Odometry::trajectory)); },
            "Final poses of all frames as known by now, smoothed, and bridged where tracking failed: N x 8, "
            "timestamp tx ty tz qx qy qz qw, as TUM's files.")
        .def(
            "live_trajectory", [](Session& self) { return toArray(self.get(&Odometry::liveTrajectory)); },
            "The poses as they were known when their frames were processed, in the same form.")
        .def(
            "keyframes", [](Session& self) { return self.get(&Odometry::keyframes); },
            "List of Keyframe; those of a map that was loaded come first, once the camera was recognised in "
            "it.")
        .def(
            "motion",
            [](Session& self, py::ssize_t from, py::ssize_t to) -> Eigen::Matrix4d {
                return self.get(&Odometry::motion, toIndex(from), toIndex(to)).matrix();
            },
            py::arg("from_index"), py::arg("to_index"),
            R"(T_from_to, 4 x 4: how the camera moved between two frames (FrameResult.index), as tracked and as the map has it by now.

Neither smoothed nor bridged, so that between poses of trajectory(), which err less, it is another one by millimetres;
motion_covariance() is of this one. The poses of two results do not make a motion where the map moved between them.
Raises IndexError.)")
        .def(
            "motion_covariance",
            [](Session& self, py::ssize_t from, py::ssize_t to) {
                return self.get(&Odometry::motionCovariance, toIndex(from), toIndex(to));
            },
            py::arg("from_index"), py::arg("to_index"),
            R"(Of that motion, 6 x 6: position (m), then orientation (rad, R <- R exp(phi)), along the second camera's axes.

Infinite where tracking was begun anew between the frames. Raises IndexError.)")
        .def_property_readonly(
            "localised", [](Session& self) { return self.get(&Odometry::isLocalised); },
            "whether all is in the world of the map that was loaded: the camera was recognised in it")
        .def(
            "map_edges", [](Session& self) { return self.get(&Odometry::map); },
            "List of MapEdge, in the world: fused over all keyframes in mode ba, else the keyframes' own.")
        .def(
            "keyframe_edges", [](Session& self) { return self.get(&Odometry::keyframeEdges); },
            "List of MapEdge as each keyframe saw them.")
        .def(
            "surface",
            [](Session& self) {
                const auto points = self.get(&Odometry::semiDense);
                using Point = ColouredPoint;
                return py::make_tuple(rows<float>(
                                          points, [](const Point& p) -> const auto& { return p.position; }),
                                      rows<std::uint8_t>(
                                          points, [](const Point& p) -> const auto& { return p.colour; }));
            },
            "The surface next to the edges: points (N x 3 float32, world, metres) and colours (N x 3 uint8, "
            "RGB).");
}

}  // namespace

void addOdometry(py::module_& module) {
    addResult(module);
    addMapParts(module);
    py::class_<Session> session(module, "Odometry", R"(RGB-D visual odometry. Feed frames in time order.

Threads may share one: they wait for each other, and Python runs on meanwhile. It stays with the process that made it:
after fork(), as by multiprocessing, make another.)");
    session
        .def(py::init<const PinholeCamera&, const py::object&, const Eigen::MatrixXd&>(), py::arg("camera"),
             py::arg("options") = py::none(),
             py::arg("T_world_start") = Eigen::MatrixXd::Identity(4, 4).eval(),
             R"(options are Options, or a dict of those that are not as by default.

T_world_start is the first frame's pose. Raises ValueError for a camera or an option that is unusable.)")
        .def_property_readonly(
            "camera", [](const Session& self) { return self.odometry().camera(); }, "as given")
        .def_property_readonly(
            "options", [](const Session& self) { return self.odometry().options(); },
            "a copy of those in use")
        .def("process", &Session::process, py::arg("colour"), py::arg("depth"), py::arg("stamp"),
             py::kw_only(), py::arg("depth_scale") = py::none(), py::arg("bgr") = false,
             py::arg("mask") = py::none(),
             R"(Tracks one frame and returns its FrameResult.

colour       uint8, height x width x 3 (RGB; BGR with bgr=True, as cv2 reads) or height x width
depth        registered to colour, height x width: uint16 with depth_scale units per metre, or float32 in metres;
             0 or NaN where unknown
stamp        seconds; later than that of the frame before
mask         bool or uint8, height x width: False or 0 where something is seen that does not stand still in the
             scene, such as the robot's own arm or a person
Arrays may have any strides. Raises TypeError and ValueError for arrays of another type or shape, which change nothing.)")
        .def(
            "refine_all", &Session::refineAll,
            R"(Refines all keyframes together, when a recording ends or whenever there is time. Frames may follow.

Returns what was left as it was and why, a line each.)")
        .def("load_map", &Session::loadMap, py::arg("file"), py::arg("localise_only") = false,
             R"(Begins with a map that save_map() or roevo-odometry --map-out wrote, before the first frame.

Poses are in its world from where the camera is recognised in it (see localised). Returns how many keyframes it has.
Raises OSError for a file that cannot be read, RuntimeError for what is no map, or one of another camera.)")
        .def("save_map", &Session::saveMap, py::arg("file"),
             R"(Writes the map for load_map() and roevo-odometry --map-in. Returns how many keyframes it has.

Raises OSError for a file that cannot be written, RuntimeError where there is no map.)");
    addPoses(session);
    module.def(
        "register_depth",
        [](const py::object& depth, const PinholeCamera& depth_camera, const PinholeCamera& colour_camera,
           const Eigen::MatrixXd& T_colour_depth, const py::object& depth_scale) {
            return registerDepth(depth, depth_camera, colour_camera, toPose(T_colour_depth, "T_colour_depth"),
                                 depth_scale);
        },
        py::arg("depth"), py::arg("depth_camera"), py::arg("colour_camera"), py::arg("T_colour_depth"),
        py::kw_only(), py::arg("depth_scale") = py::none(),
        R"(Depth as the colour camera would see it, float32 in metres, 0 where nothing fell.

depth           of the depth camera, as Odometry.process() takes it
T_colour_depth  4 x 4, maps points of the depth camera into the colour camera)");
}

}  // namespace roevo::python
