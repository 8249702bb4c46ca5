// Poses out of the matrices and quaternions of data sets.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <string>

#include "algorithm/dataset/stated_view.h"

namespace sgs {

// world_from_camera: a rigid motion, columns as glm has them, of a camera with x right, y down, z
// forward axes. Throws InputError that begins with `where`: a number that is not finite, axes that
// are not orthonormal within 1e-3 or mirror, a last row that is not 0 0 0 1.
Pose opencv_pose(const glm::dmat4& world_from_camera, const std::string& where);

// The same for x right, y up, z backward axes (OpenGL, Blender).
Pose opengl_pose(const glm::dmat4& world_from_camera, const std::string& where);

// v = R p + translation takes the world into the camera, whose axes are x right, y down, z forward;
// R of the quaternion, whose length does not matter. Throws InputError that begins with `where`: a
// number that is not finite, a quaternion of length 0.
Pose colmap_pose(const glm::dquat& camera_from_world, const glm::dvec3& translation,
                 const std::string& where);

}  // namespace sgs
