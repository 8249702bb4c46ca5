// What lies where: regions apart from each other, and the tables of each order.
#include "algorithm/memory/scene_layout.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/voxel/chunk_tree.h"

namespace sgs {
namespace {

using Encoding = SecondHalfEncoding;

TEST_CASE("regions: one behind the other, on rows of 4 KiB, whatever is empty") {
  Regions regions;
  CHECK(regions.total_bytes() == 0);
  CHECK(regions.next_base() == 0);
  const std::vector<std::pair<std::uint64_t, std::uint64_t>> size_and_base = {
      {0, 0}, {1, 0}, {0, 4096}, {4096, 4096}, {4097, 8192}, {8192, 16384}, {1ULL << 40, 24576}};
  for (const auto& [bytes, base] : size_and_base) {
    const RegionSpan span = regions.add("r" + std::to_string(regions.size()), bytes);
    CHECK(span.region + 1U == regions.size());
    CHECK(span.base == base);
    CHECK(span.bytes == bytes);
    CHECK(regions[span.region].base == base);
    CHECK(regions[span.region].bytes == bytes);
    CHECK(regions[span.region].name == "r" + std::to_string(span.region));
    CHECK(regions.total_bytes() == base + bytes);
  }
  CHECK(regions.next_base() == 24576 + (1ULL << 40));
}

TEST_CASE("regions: names are told apart, and so are as many as a transaction can name") {
  Regions regions;
  regions.add("spill", 1);
  CHECK_THROWS_AS(regions.add("spill", 1), std::invalid_argument);
  while (regions.size() < 256) regions.add(std::to_string(regions.size()), 1);
  CHECK_THROWS_AS(regions.add("one more", 1), std::length_error);
  CHECK(regions.size() == 256);
}

TEST_CASE("regions: addresses are base plus record size times number, beyond 4 GiB too") {
  const RegionSpan span{3, 12288, 1ULL << 40};
  const RecordArray records = span.records(4096, 76, 4000000001);
  CHECK(records.region == 3);
  CHECK(records.address(0) == 16384);
  CHECK(records.address(7) == 16384 + 7 * 76);
  CHECK(records.address(4000000000U) == 16384 + std::uint64_t{4000000000U} * 76);
  CHECK(records.end() == records.address(4000000000U) + 76);
  CHECK(records.bytes() == 4000000001ULL * 76);
  const RegionSpan part = span.part(4096, 512);
  CHECK(part.region == 3);
  CHECK(part.base == 16384);
  CHECK(part.end() == 16384 + 512);
}

// A table's records lie in its region, and carry its number.
void check_in(const Regions& regions, const char* name, const RecordArray& records) {
  INFO(name);
  const Region& region = regions[records.region];
  CHECK(region.name == name);
  CHECK(records.base >= region.base);
  CHECK(records.end() <= region.end());
}

TEST_CASE("scene layout: tables and records lie in the regions that they name") {
  const SecondHalfFormat format{Encoding::kVqPacked, 1, {16, 8, 4, 2}};
  const SceneLayout voxels = lay_out_voxels(format, 1000, {0.5F, {-1, 0, 7}, 3}, 5, 40);
  CHECK(voxels.order() == StorageOrder::kVoxels);
  CHECK(voxels.gaussian_count() == 1000);
  CHECK(voxels.sh_degree() == 1);
  const VoxelTableLayout& grid = voxels.voxel_table();
  check_in(voxels.regions, "voxel_table", grid.nodes);
  check_in(voxels.regions, "voxel_table", grid.voxels);
  check_in(voxels.regions, "voxel_table", grid.cuts);
  CHECK(grid.cuts.count == 32);  // a plane for every 32 slots
  CHECK(grid.cuts.address(1) == 5 * 16 + 40 * 8 + 4);
  CHECK(grid.nodes.address(3) == 3 * sizeof(VoxelNode));
  CHECK(grid.voxels.address(2) == 5 * 16 + 2 * 8);
  CHECK(grid.frame.voxel_size == 0.5F);
  CHECK_THROWS_AS(voxels.chunk_table(), std::bad_variant_access);

  const SceneLayout chunks = lay_out_chunks(format, 1000, 9, 63);
  CHECK(chunks.order() == StorageOrder::kChunks);
  const ChunkTableLayout& tree = chunks.chunk_table();
  check_in(chunks.regions, "chunk_table", tree.nodes);
  CHECK(tree.nodes.record_bytes == sizeof(ChunkNode));
  CHECK(tree.nodes.count == 9);
  CHECK(tree.chunk_count == 63);
  CHECK_THROWS_AS(chunks.voxel_table(), std::bad_variant_access);

  const SceneLayout file = lay_out_file(format, 1000);
  CHECK(file.order() == StorageOrder::kFile);
  CHECK(file.regions.size() == 3);
  CHECK_THROWS_AS(file.voxel_table(), std::bad_variant_access);
  CHECK_THROWS_AS(file.chunk_table(), std::bad_variant_access);
  for (const SceneLayout& layout : {voxels, chunks, file}) {
    check_in(layout.regions, "first_halves", layout.first_halves);
    check_in(layout.regions, "second_halves", layout.second_halves);
    const RecordSplit split = split_of(layout.order(), format);
    CHECK(layout.split.bound_by == split.bound_by);
    CHECK(layout.first_halves.record_bytes == split.first_bytes());
    CHECK(layout.second_halves.record_bytes == split.second_bytes);
    CHECK(layout.record_bytes() == split.first_bytes() + split.second_bytes);
    CHECK(layout.regions[layout.codebooks.region].name == "codebooks");
    CHECK(layout.codebooks.bytes == format.codebook_bytes());
    CHECK(layout.stored_bytes == layout.regions.next_base());
  }
}

}  // namespace
}  // namespace sgs
