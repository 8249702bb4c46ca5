// Every byte of a scene where its layout says.
#include "algorithm/storage/build_memory_image.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/splat/activate.h"
#include "testbench/builtin/open_scene.h"
#include "tests/algorithm/voxel/stored_clouds.h"

namespace sgs {
namespace {

ActivatedCloud object_2k() { return activate(open_scene("builtin:object?n=2000").cloud); }

template <class Record>
void check_table(const MemoryImage& image, const RecordArray& table,
                 const std::vector<Record>& expected) {
  REQUIRE(table.count == expected.size());
  REQUIRE(table.record_bytes == sizeof(Record));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    REQUIRE(std::memcmp(image.at(table.address(i)), &expected[i], sizeof(Record)) == 0);
  }
}

void check_records(const MemoryImage& image, const ActivatedCloud& cloud) {
  const SceneLayout& layout = image.layout;
  REQUIRE(layout.gaussian_count() == cloud.size());
  REQUIRE(image.bytes.size() == layout.stored_bytes);
  for (std::uint32_t slot = 0; slot < layout.gaussian_count(); ++slot) {
    const Gaussian<float>& g = cloud.gaussians[slot];
    const SplitFirstHalf first =
        read_first_half(layout.split, image.at(layout.first_halves.address(slot)));
    const DecodedGaussian back =
        read_record(layout.split, layout.second_half, first.mean, first.carried,
                    image.at(layout.second_halves.address(slot)), nullptr);
    REQUIRE(std::memcmp(&back.gaussian, &g, sizeof g) == 0);
    REQUIRE(std::memcmp(back.sh, cloud.sh(slot), 16 * sizeof(glm::vec3)) == 0);
  }
}

TEST_CASE("memory image: every record lies at its address, by voxels, chunks and file") {
  const ActivatedCloud in_file = object_2k();
  const auto [in_voxels, grid] = test::by_voxels(in_file, 0.4F);
  const MemoryImage by_voxels = build_memory_image(encode_raw(in_voxels), grid);
  check_records(by_voxels, in_voxels);
  check_table(by_voxels, by_voxels.layout.voxel_table().nodes, grid.nodes);
  check_table(by_voxels, by_voxels.layout.voxel_table().voxels, grid.voxels);

  const auto [in_chunks, tree] = test::by_chunks(in_file, 16);
  const MemoryImage by_chunks = build_memory_image(encode_raw(in_chunks), tree);
  check_records(by_chunks, in_chunks);
  check_table(by_chunks, by_chunks.layout.chunk_table().nodes, tree.nodes);
  CHECK(by_chunks.layout.chunk_table().chunk_count == tree.chunk_count);

  check_records(build_memory_image(encode_raw(in_file), NoTable{}), in_file);
}

TEST_CASE("memory image: an empty scene has no bytes") {
  for (const MemoryImage& image : {build_memory_image(EncodedCloud{}, VoxelGrid{}),
                                   build_memory_image(EncodedCloud{}, ChunkTree{}),
                                   build_memory_image(EncodedCloud{}, NoTable{})}) {
    CHECK(image.bytes.empty());
    CHECK(image.layout.gaussian_count() == 0);
  }
}

}  // namespace
}  // namespace sgs
