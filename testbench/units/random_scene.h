// Small random scenes, laid out in memory and with a camera, as VSU and HFUs see them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/streaming_job.h"

namespace sgs::tb {

struct SceneShape {
  std::size_t gaussians = 200;
  int sh_degree = 1;
  SecondHalfEncoding encoding = SecondHalfEncoding::kRaw;
  StorageOrder order = StorageOrder::kVoxels;  // order of the image; there is a grid all the same
  float extent = 4;  // world units, half the side of the cube that holds the centres
  float voxel_size = 1;
  int width_px = 48, height_px = 40;
  PixelSize group = square_of(16);
};

struct TestScene {
  ActivatedCloud cloud;  // the decoded records of the image, by slot
  VoxelGrid grid;
  MemoryImage image;
  StreamingJob job;
};

// Scales from a thousandth of the extent to the extent, opacities from 0 to 1, some never visible;
// a camera inside or outside that looks somewhere near the middle or, one time in four, along an
// axis from a corner of a voxel.
TestScene random_scene(std::mt19937_64& random, const SceneShape& shape);

// All of it at random.
SceneShape random_shape(std::mt19937_64& random);

}  // namespace sgs::tb
