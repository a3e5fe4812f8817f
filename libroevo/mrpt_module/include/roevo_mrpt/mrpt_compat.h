#pragma once
/// What differs between MRPT's versions, in one place: 2.5 (Debian 12), 2.14 (Debian 13), and of 3 what its
/// headers say of scenes (nothing was built with it yet).

#include <mrpt/img/TColor.h>

#if __has_include(<mrpt/viz/Scene.h>)
#include <mrpt/viz/CVisualObject.h>
#include <mrpt/viz/Scene.h>
#else
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CRenderizableShaderPoints.h>
#endif

namespace roevo::compat {

#if __has_include(<mrpt/viz/Scene.h>)
namespace scene = mrpt::viz;  ///< what scenes are made of
using Scene = mrpt::viz::Scene;
using SceneObject = mrpt::viz::CVisualObject;
using ScenePoints = mrpt::viz::VisualObjectParams_Points;
#else
namespace scene = mrpt::opengl;
using Scene = mrpt::opengl::COpenGLScene;
using SceneObject = mrpt::opengl::CRenderizable;
using ScenePoints = mrpt::opengl::CRenderizableShaderPoints;
#endif

/// Sets one of a viewport's lights, which is a colour up to MRPT 2.5 and a brightness in 2.14.
inline void setWhiteLight(mrpt::img::TColorf& light, float brightness) {
    light = {brightness, brightness, brightness};
}
inline void setWhiteLight(float& light, float brightness) {
    light = brightness;
}

}  // namespace roevo::compat
