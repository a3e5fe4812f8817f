#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace roevo {

/// What a picture is drawn on. Colours that would not stand out from it are changed.
enum class Background { kDark, kWhite };

/// Where a scene is looked at from. The camera is optical: x right, y down, z forward.
struct View {
    Eigen::Isometry3d T_scene_camera = Eigen::Isometry3d::Identity();
    double vertical_fov_deg = 40;
    double near = 0.01, far = 1000;  ///< m, clipping planes
};

/// What a view has to show, in scene coordinates (x forward, y left, z up; metres).
struct ViewContent {
    std::vector<Eigen::Vector3f>
        cloud;  ///< shown but for a few per cent, so that outliers do not shrink the picture
    std::vector<Eigen::Vector3f> must_see;  ///< shown entirely: trajectory, frusta
};

/// Looks along `direction` with `up` upwards, from the nearest place that has the content in the picture.
/// @param aspect  width by height. @throws std::runtime_error when there is nothing to show
View frameContent(const ViewContent& content, const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                  double aspect);

/// One of the fixed views: iso (from a raised corner), top (forward is up), front (along the first camera's
/// axis).
View fixedView(const std::string& name, const ViewContent& content, double aspect);

/// From behind and above a camera of the scene, looking where it looks.
View followView(const Eigen::Isometry3d& T_scene_camera, const ViewContent& content);

}  // namespace roevo
