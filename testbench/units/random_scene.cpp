// Making and comparing of scenes and splats.
#include "testbench/units/random_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "algorithm/render/group_state.h"
#include "algorithm/storage/encoded_cloud.h"
#include "testbench/units/job_memory.h"

namespace sgs::tb {

namespace {

glm::vec3 in_cube(std::mt19937_64& random, float half_side) {
  glm::vec3 out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = uniform(random, -half_side, half_side);
  return out;
}

ActivatedCloud random_cloud(std::mt19937_64& random, const SceneShape& shape) {
  ActivatedCloud cloud;
  cloud.sh_degree = shape.sh_degree;
  const auto coeffs = static_cast<std::size_t>((shape.sh_degree + 1) * (shape.sh_degree + 1));
  for (std::size_t i = 0; i < shape.gaussians; ++i) {
    Gaussian<float> g{};
    g.mean = in_cube(random, shape.extent);
    for (int axis = 0; axis < 3; ++axis) {
      g.scale[axis] =
          shape.extent * std::exp(uniform(random, -7.0F, random() % 10 == 0 ? 0 : -2.5F));
    }
    float squared = 0;
    for (float& component : g.quat) {
      component = uniform(random, -1, 1);
      squared += component * component;
    }
    for (float& component : g.quat) component /= std::sqrt(squared);
    g.opacity = random() % 8 == 0 ? 0.001F : uniform(random, 0.0F, 1.0F);
    cloud.gaussians.push_back(g);
    for (std::size_t k = 0; k < coeffs; ++k) cloud.sh_coeffs.push_back(in_cube(random, 1));
  }
  return cloud;
}

Camera random_camera(std::mt19937_64& random, const SceneShape& shape) {
  Camera camera;
  camera.width = shape.width_px;
  camera.height = shape.height_px;
  const double longest = std::max(camera.width, camera.height);
  camera.focal_x = camera.focal_y = longest * uniform(random, 0.5F, 2.0F);
  if (random() % 4 == 0) {
    camera.position = glm::dvec3(shape.voxel_size * std::floor(uniform(random, -3, 3)));
    return camera;  // looks along z
  }
  camera.position = in_cube(random, shape.extent * (random() % 2 == 0 ? 0.8F : 3.0F));
  const glm::dvec3 target = in_cube(random, shape.extent * 0.3F);
  const glm::dvec3 forward = glm::normalize(target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, -1, 0), forward));
  camera.world_from_camera = {right, glm::cross(forward, right), forward};
  return camera;
}

// Codebooks of few entries, so that small scenes fill them.
EncodedCloud encode(ActivatedCloud cloud, SecondHalfEncoding encoding) {
  if (encoding == SecondHalfEncoding::kRaw) return encode_raw(std::move(cloud));
  if (encoding == SecondHalfEncoding::kHalf) return encode_half(cloud);
  VqConfig config;
  config.scale_entries = 48;
  config.rotation_entries = 100;
  config.dc_entries = 64;
  config.sh_entries = 20;
  config.iterations = 2;
  const std::vector<float> weights(cloud.size(), 1.0F), pixel_sizes(cloud.size(), 0.0F);
  return encode_quantised(cloud, quantise(cloud, weights, pixel_sizes, config), encoding);
}

// Some range [low, high) of sub-tiles that overlaps [first, end), within [0, limit).
void overlapping(std::mt19937_64& random, int first, int end, int limit, std::uint16_t& low,
                 std::uint16_t& high) {
  constexpr int kBeyond = 3;
  const int inside = whole(random, first, end - 1);
  low = static_cast<std::uint16_t>(std::max(0, whole(random, first - kBeyond, inside)));
  high = static_cast<std::uint16_t>(std::min(limit, whole(random, inside + 1, end + kBeyond)));
}

}  // namespace

TestScene random_scene(std::mt19937_64& random, const SceneShape& shape) {
  TestScene scene;
  EncodedCloud encoded = encode(random_cloud(random, shape), shape.encoding);
  auto [grid, order] = arrange_by_voxels(encoded.decoded, shape.voxel_size);
  encoded = reordered(std::move(encoded), order);
  scene.grid = std::move(grid);
  const Camera camera = random_camera(random, shape);
  StreamingJob& job = scene.job;
  job.view = make_view<float>(camera);
  job.groups = pixel_groups(camera.width, camera.height, shape.group);
  job.parts = {job.groups};
  // Records as the order has them, in the order of the grid; the tree's nodes are not read.
  constexpr std::uint32_t kChunkGaussians = 16;
  switch (shape.order) {
    case StorageOrder::kVoxels:
      scene.image = build_memory_image(encoded, scene.grid);
      break;
    case StorageOrder::kChunks:
      scene.image =
          build_memory_image(encoded, arrange_by_chunks(encoded.decoded, kChunkGaussians).table);
      break;
    case StorageOrder::kFile:
      scene.image = build_memory_image(encoded, NoTable{});
      break;
  }
  scene.cloud = std::move(encoded.decoded);
  place(scene.image.layout, 0, job);
  return scene;
}

SceneShape random_shape(std::mt19937_64& random) {
  SceneShape shape;
  constexpr std::size_t kCounts[] = {0, 1, 20, 300, 1000};
  shape.gaussians = kCounts[random() % 5];
  shape.sh_degree = static_cast<int>(random() % 4);
  shape.voxel_size = std::exp2(uniform(random, -3, 4));
  shape.width_px = 1 + static_cast<int>(random() % 60);
  shape.height_px = 1 + static_cast<int>(random() % 40);
  shape.group = {4 * (1 + static_cast<int>(random() % 16)),
                 4 * (1 + static_cast<int>(random() % 16))};
  return shape;
}

SubtileRect subtiles_of(const PixelRect& pixels) {
  const auto down = [](int px) { return static_cast<std::uint16_t>(px / kSubtilePx); };
  return {down(pixels.x0), down(pixels.y0), down(pixels.x1 + kSubtilePx - 1),
          down(pixels.y1 + kSubtilePx - 1)};
}

StreamingJob frame_job(int width_px, int height_px, const PixelSize& group, FrameFormat format,
                       std::uint64_t spill_bytes, const SceneLayout& layout) {
  StreamingJob job;
  job.view.width = width_px;
  job.view.height = height_px;
  job.background = {0.25F, 0.5F, 0.75F};
  job.frame_format = format;
  job.groups = pixel_groups(width_px, height_px, group);
  job.parts = {job.groups};
  place(layout, spill_bytes, job);
  return job;
}

Splat random_splat(std::mt19937_64& random, const PixelRect& group, const FrameJob& job,
                   std::uint32_t index, float opacity) {
  Splat splat{};
  splat.x = uniform(random, static_cast<float>(group.x0) - 4, static_cast<float>(group.x1) + 4);
  splat.y = uniform(random, static_cast<float>(group.y0) - 4, static_cast<float>(group.y1) + 4);
  splat.conic_a = uniform(random, 0.001F, 0.5F);
  splat.conic_c = uniform(random, 0.001F, 0.5F);
  splat.conic_b = uniform(random, -0.9F, 0.9F) * std::sqrt(splat.conic_a * splat.conic_c);
  splat.opacity = uniform(random, 0.0F, opacity);
  splat.depth = static_cast<float>(whole(random, 1, 20)) * 0.37F;
  splat.index = index;
  splat.rgb = {uniform(random, 0.0F, 1.0F), uniform(random, 0.0F, 1.0F),
               uniform(random, 0.0F, 2.0F)};
  const SubtileRect tiles = subtiles_of(group);
  const SubtileRect frame = subtiles_of({0, 0, job.view.width, job.view.height});
  overlapping(random, tiles.x0, tiles.x1, frame.x1, splat.footprint.x0, splat.footprint.x1);
  overlapping(random, tiles.y0, tiles.y1, frame.y1, splat.footprint.y0, splat.footprint.y1);
  return splat;
}

std::string difference(const Splat& got, const Splat& expected, const SubtileRect& group) {
  if (std::memcmp(&got.x, &expected.x, offsetof(Splat, index)) != 0) return "geometry or depth";
  if (got.index != expected.index) {
    return fmt::format("index {}, expected {}", got.index, expected.index);
  }
  if (std::memcmp(&got.rgb, &expected.rgb, sizeof got.rgb) != 0) return "colour";
  if (!(intersection(got.footprint, group) == intersection(expected.footprint, group))) {
    return "footprint";
  }
  return "";
}

}  // namespace sgs::tb
