#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace roevo {

/// Where a scene is looked at from. The camera is optical: x right, y down, z forward.
struct View {
    Eigen::Isometry3d T_scene_camera = Eigen::Isometry3d::Identity();
    double vertical_fov_deg = 40;
    double near = 0.01, far = 1000;  ///< m, clipping planes
    double distance = 1;             ///< m, from the camera to the middle of what it shows
    bool parallel = false;           ///< from so far away that a metre is as long everywhere in the picture

    /// Length of a metre in the picture, across the line of sight at `distance`. @param height  pixels
    double pixelsPerMetre(int height) const;
};

/// What a view has to show, in scene coordinates (x forward, y left, z up; metres).
struct ViewContent {
    std::vector<Eigen::Vector3f> cloud;     ///< shown but for strays far from all others
    std::vector<Eigen::Vector3f> must_see;  ///< shown entirely: trajectory, frusta
};

/// The box around all that is shown. @throws std::runtime_error when there is nothing to show
Eigen::AlignedBox3f boundsOf(const ViewContent& content);

/// Looks along `direction` with `up` upwards, from the nearest place that has the content in the picture.
/// @param aspect  width by height. @throws std::runtime_error when there is nothing to show
View frameContent(const ViewContent& content, const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                  double aspect, double vertical_fov_deg);

/// One of the fixed views: iso (from a raised corner), top (forward is up; rays are parallel), front (along
/// the first camera's axis).
View fixedView(const std::string& name, const ViewContent& content, double aspect);

/// From behind and above a camera of the scene, looking where it looks.
View followView(const Eigen::Isometry3d& T_scene_camera, const ViewContent& content);

/// From one point to another, which is in the middle of the picture; z is up, or x for a look straight down
/// or up. @param from, to  different points
View lookAt(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// From above at an angle, so far away that the content stays in the picture when the view is turned about
/// the vertical axis through its middle. @throws std::runtime_error when there is nothing to show
View orbitView(const ViewContent& content, double aspect);

/// The view turned about the vertical axis through the middle of what it shows.
View turned(const View& view, double angle);

/// The middle of the picture magnified.
View zoomed(View view, double factor);

}  // namespace roevo
