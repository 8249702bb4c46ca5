// What lies where: regions apart from each other, records where their addresses say.
#include "algorithm/memory/memory_image.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/scene/load_scene.h"
#include "algorithm/splat/activate.h"

namespace sgs {
namespace {

struct Scene2k {
  ActivatedCloud cloud = activate(load_scene("builtin:object?n=2000").cloud);
  VoxelGrid grid = build_voxel_grid(cloud, 0.4F);
};

TEST_CASE("memory image: regions do not overlap and begin on rows of 4 KiB") {
  const Scene2k scene;
  const MemoryLayout layout = with_working_regions(
      build_memory_image(encode_raw(scene.cloud), scene.grid).layout, 12345, 678);
  std::uint64_t end = 0;
  for (const RegionRange& range : layout.regions) {
    CHECK(range.base % 4096 == 0);
    CHECK(range.base >= end);
    CHECK(range.base - end < 4096);
    end = range.end();
  }
  CHECK(layout.total_bytes() == end);
  CHECK(layout[Region::kSpill].bytes == 12345);
  CHECK(layout[Region::kFrameBuffer].bytes == 678);
  CHECK(layout[Region::kFirstHalves].bytes == 16 * scene.grid.storage_order.size());
  CHECK(layout[Region::kSecondHalves].bytes == 220 * scene.grid.storage_order.size());
  CHECK(layout[Region::kVoxelTable].bytes ==
        16 * scene.grid.nodes.size() + 8 * scene.grid.voxels.size());
}

TEST_CASE("memory image: addresses are base plus record size times number") {
  MemoryLayout layout;
  layout.regions[region_id(Region::kVoxelTable)] = {4096, 1000};
  layout.regions[region_id(Region::kFirstHalves)] = {8192, 16 * 10};
  layout.regions[region_id(Region::kSecondHalves)] = {12288, 76 * 10};
  layout.regions[region_id(Region::kFrameBuffer)] = {16384, 3 * 64};
  layout.node_count = 5;
  layout.second_half.sh_degree = 1;
  CHECK(layout.node_address(3) == 4096 + 3 * 16);
  CHECK(layout.voxel_address(2) == 4096 + 5 * 16 + 2 * 8);
  CHECK(layout.first_half_address(7) == 8192 + 7 * 16);
  CHECK(layout.second_half_address(7) == 12288 + 7 * 76);
  CHECK(layout.pixel_address(3, 2, 8, FrameFormat::kRgb8) == 16384 + (2 * 8 + 3) * 3);
  CHECK(layout.pixel_address(3, 2, 8, FrameFormat::kRgb32f) == 16384 + (2 * 8 + 3) * 12);
  // Beyond 4 GiB too.
  CHECK(layout.second_half_address(4000000000U) == 12288 + std::uint64_t{4000000000U} * 76);
}

TEST_CASE("memory image: every record lies at its address") {
  const Scene2k scene;
  const MemoryImage image = build_memory_image(encode_raw(scene.cloud), scene.grid);
  const MemoryLayout& layout = image.layout;
  REQUIRE(image.bytes.size() >= layout[Region::kSecondHalves].end());
  for (std::uint32_t n = 0; n < scene.grid.nodes.size(); ++n) {
    REQUIRE(std::memcmp(&image.bytes[layout.node_address(n)], &scene.grid.nodes[n], 16) == 0);
  }
  for (std::uint32_t v = 0; v < scene.grid.voxels.size(); ++v) {
    REQUIRE(std::memcmp(&image.bytes[layout.voxel_address(v)], &scene.grid.voxels[v], 8) == 0);
  }
  for (std::uint32_t slot = 0; slot < layout.gaussian_count; ++slot) {
    const std::uint32_t index = scene.grid.storage_order[slot];
    const Gaussian<float>& g = scene.cloud.gaussians[index];
    const FirstHalf first = decode_first_half(&image.bytes[layout.first_half_address(slot)]);
    const DecodedGaussian back =
        decode_raw_second_half(first, &image.bytes[layout.second_half_address(slot)], 3);
    REQUIRE(std::memcmp(&back.gaussian, &g, sizeof g) == 0);
    REQUIRE(std::memcmp(back.sh, scene.cloud.sh(index), 16 * sizeof(glm::vec3)) == 0);
  }
}

TEST_CASE("memory image: an empty scene has empty regions and a frame") {
  const MemoryLayout layout =
      with_working_regions(build_memory_image(EncodedCloud{}, VoxelGrid{}).layout, 0, 300);
  CHECK(layout.gaussian_count == 0);
  CHECK(layout[Region::kFirstHalves].bytes == 0);
  CHECK(layout[Region::kFrameBuffer].bytes == 300);
}

}  // namespace
}  // namespace sgs
