// Random inputs of units: small scenes, laid out in memory and with a camera, as VSU and HFUs see
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/splat.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/streaming_job.h"

namespace sgs::tb {

// Numbers drawn evenly from an interval, for random cases.
inline float uniform(std::mt19937_64& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

// Both ends are among them.
inline int whole(std::mt19937_64& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}

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

// Splats as the fine filter could hand them on, and groups of a frame for them to lie in.

// A frame of width x height px with its groups and, behind the layout's regions, a spill region and
// a frame buffer.
StreamingJob frame_job(int width_px, int height_px, const PixelSize& group, FrameFormat format,
                       std::uint64_t spill_bytes, const SceneLayout& layout = {});

// A splat whose footprint overlaps the group. Depths are few, so that many are equal. opacity: at
// most this.
Splat random_splat(std::mt19937_64& random, const PixelRect& group, const FrameJob& job,
                   std::uint32_t index, float opacity);

// Sub-tiles of a group.
SubtileRect subtiles_of(const PixelRect& pixels);

// Empty where both are the same to the bit; else which field differs. Footprints are compared
// where they overlap the group.
std::string difference(const Splat& got, const Splat& expected, const SubtileRect& group);

}  // namespace sgs::tb
