// The statements of a data set's files, before images and cameras are brought together.
#pragma once

#include <functional>
#include <glm/ext/vector_uint3_sized.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/dataset/dataset.h"
#include "algorithm/dataset/lens.h"
#include "algorithm/dataset/view_cameras.h"

namespace sgs {

struct Intrinsics {
  int width = 0, height = 0;  // px, from 1; the image may have another size. 0: the image's own
  // px. Where there is none, angles of the whole sides, radians: one of the four is stated.
  std::optional<double> focal_x, focal_y, angle_x, angle_y;
  std::optional<double> centre_x, centre_y;  // principal point, px from the top left corner
  Lens lens;
};

// Intrinsics with all said, in px.
struct Projection {
  int width = 0, height = 0;
  glm::dvec2 focal{0.0};
  glm::dvec2 centre{0.0};
};

// image_width, image_height: taken where none are stated. What else is not stated: the principal
// point is in the middle, a focal length as the other one.
Projection projection_of(const Intrinsics& stated, int image_width, int image_height);

// As in Camera, which it becomes part of.
struct Pose {
  glm::dvec3 position{0.0};
  glm::dmat3 world_from_camera{1.0};
  std::string_view axes;
};

struct StatedView {
  std::string where;                 // file and entry, for messages
  std::vector<std::string> folders;  // where its image may be, below the data set's folder
  std::string image, mask;           // names as the file has them; mask: empty where there is none
  std::optional<int> id;             // that the file gives the camera, whose name is then `image`
  Intrinsics intrinsics;
  Pose pose;
  Split split = Split::kTrain;  // where the data set has a split
  // One angle of all stands for a size that nobody states: its image has the shape of the others'.
  bool shares_shape = false;
};

struct StatedDataset {
  std::vector<std::string> files;  // files of the data set except its images
  std::vector<StatedView> views;
  SplitBy split_by = SplitBy::kEveryEighth;
  std::string tests_from;  // file and entry that name the test views, where there is a split
  int left_out = 0;
  std::function<std::vector<SfmPoint>()> read_points;  // empty where there are none
  std::optional<Extent> bounds;
  PathFacts path;
  std::map<std::string, int> unread_keys;  // names that say nothing here, and how often they occur
};

// Throws InputError that begins with view.where: a lens that check_lens() refuses, a focal length
// or position that is not finite or beyond scene/gaussian_cloud.h.
void check_camera(const StatedView& view, const Projection& projection);

// The pinhole with this projection; check_camera() has passed it. Throws InputError that begins
// with view.where: a principal point outside of the picture.
Camera camera_of(const StatedView& view, const Projection& projection);

// world_from_camera: a rigid motion, columns as glm has them, of a camera with x right, y down, z
// forward axes. where: file, entry and key. Throws InputError that begins with it: a number that is
// not finite, axes that are not orthonormal within 1e-3 or mirror, a last row that is not 0 0 0 1.
Pose opencv_pose(const glm::dmat4& world_from_camera, const std::string& where);

// The same for x right, y up, z backward axes (OpenGL, Blender).
Pose opengl_pose(const glm::dmat4& world_from_camera, const std::string& where);

// v = R p + translation takes the world into the camera, whose axes are x right, y down, z forward;
// R of the quaternion, whose length does not matter. Throws InputError that begins with `where`: a
// number that is not finite, a quaternion of length 0.
Pose colmap_pose(const glm::dquat& camera_from_world, const glm::dvec3& translation,
                 const std::string& where);

// The point that these numbers state. Throws InputError that begins with `where`: coordinates that
// are not finite or too large.
SfmPoint sfm_point(const glm::dvec3& position, const glm::u8vec3& colour, const std::string& where);

}  // namespace sgs
