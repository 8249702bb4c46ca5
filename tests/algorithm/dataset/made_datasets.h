// Small data sets of each layout, written into a folder by what the formats say, not by the
// project's own conversions.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs::test {

// A camera by its axes in the world.
struct MadeCamera {
  glm::dvec3 position, right, down, forward;
};

struct MadePoint {
  glm::dvec3 position;
  glm::u8vec3 colour;
};

struct PhotographedScene {
  int width = 64, height = 48;        // px
  double focal_x = 60, focal_y = 60;  // px
  glm::dvec2 principal{32, 24};       // px from the top left corner
  std::vector<MadeCamera> cameras;    // 10 of them on an arc, none alike
  std::vector<MadePoint> points;      // seen by all of them, apart from each other
};

PhotographedScene made_scene();

// Where `camera` has `point`, px from the top left corner: the centre of the first pixel is 0.5.
glm::dvec2 projected(const PhotographedScene& scene, const MadeCamera& camera,
                     const glm::dvec3& point);

// A disc of its colour where each point is, before nothing (alpha 0).
RgbaImage picture_of(const PhotographedScene& scene, const MadeCamera& camera);

std::string rgba_png(const RgbaImage& image);
std::string grey_before_png(const RgbaImage& image);  // opaque, before grey
std::string grey_before_jpeg(const RgbaImage& image);

// Writes `bytes` to folder/name, making folders.
void write_file(const std::string& folder, const std::string& name, const std::string& bytes);

// Each writes cameras and pictures below `folder`. Views are in the order of the cameras when
// sorted by name.
void write_colmap_binary(const std::string& folder, const PhotographedScene& scene);
void write_colmap_text(const std::string& folder, const PhotographedScene& scene);
void write_nerf_synthetic(const std::string& folder, const PhotographedScene& scene);
void write_transforms(const std::string& folder, const PhotographedScene& scene);
void write_cameras_json(const std::string& folder, const PhotographedScene& scene);
void write_nsvf_matrix(const std::string& folder, const PhotographedScene& scene);
void write_nsvf_focal(const std::string& folder, const PhotographedScene& scene);

}  // namespace sgs::test
