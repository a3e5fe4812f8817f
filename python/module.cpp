// import roevo: the odometry for Python, images and results as numpy arrays.
#include "bindings.h"
#include "roevo/odometry.h"

PYBIND11_MODULE(roevo, module) {
    module.doc() = R"(RGB-D visual odometry from organized edges.

    import roevo
    odometry = roevo.Odometry(roevo.Camera(640, 480, 525, 525, 319.5, 239.5))
    for colour, depth, stamp in frames:                    # numpy arrays, seconds
        result = odometry.process(colour, depth, stamp, depth_scale=5000)
        print(result.status, result.pose)
    odometry.refine_all()
    trajectory = odometry.trajectory()                     # N x 8, TUM's columns

Poses are 4 x 4 matrices T_world_camera, which map points of the camera (x right, y down, z forward, metres) into the
world. What is wrong with arguments is told by ValueError and TypeError in one line; a bad frame is no error, but comes
back as "rejected" with a reason. The same frames give the same poses as roevo-odometry does, to the last bit.)";
    module.attr("__version__") = roevo::version();
    roevo::python::addCamera(module);
    roevo::python::addOptions(module);
    roevo::python::addOdometry(module);
}
