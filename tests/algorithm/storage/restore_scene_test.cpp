// Scenes out of their images: the same bits to golden renderers, and nothing impossible believed.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/storage/stored_scene.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/storage/packed_scenes.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;
constexpr StorageOrder kVoxels = StorageOrder::kVoxels, kChunks = StorageOrder::kChunks,
                       kFile = StorageOrder::kFile;

View<float> small_view() {
  const std::vector<Camera> cameras = make_builtin_scene("builtin:object?n=8").cameras;
  return make_view<float>(scaled_to(cameras[1], 96, 54));
}

// What golden renderers make of each order's table.
struct Golden {
  const View<float>& view;
  const ActivatedCloud& decoded;

  StreamingResult operator()(const ChunkTree& tree) const {
    ExactOrderConfig config;
    config.group = square_of(32);
    return render_exact_order(view, decoded, tree, config);
  }
  StreamingResult operator()(const VoxelGrid& grid) const {
    PaperOrderConfig config;
    config.group = square_of(32);
    return render_paper_order(view, decoded, grid, config);
  }
  // Without a table: the reference picture, which sorts by itself.
  StreamingResult operator()(NoTable) const {
    StreamingResult out;
    out.frame = render_reference(view, decoded);
    for (const std::uint32_t blends : out.frame.contributors) out.stats.contributors += blends;
    return out;
  }
};

StreamingResult golden(const View<float>& view, const StoredScene& scene) {
  return std::visit(Golden{view, scene.decoded}, scene.table);
}

bool same_pictures(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof a.pixels[0]) == 0;
}

TEST_CASE("restore: golden pictures and statistics of every encoding, order and degree") {
  const View<float> view = small_view();
  static_assert(sizeof(StreamingStats) % sizeof(std::uint64_t) == 0);
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      for (int degree = 0; degree <= 3; ++degree) {
        CAPTURE(static_cast<int>(order), static_cast<int>(encoding), degree);
        const Packing packing = make_packing(cut_object(1500, degree), encoding, order);
        const StoredScene back = restore_scene(packing.packed(), "scene.sgs");
        CHECK(back.gaussians == 1500);
        CHECK(back.decoded.size() < 1500);  // what nobody can see is not stored
        CHECK(back.image.bytes == packing.stored.image.bytes);
        CHECK(back.image.layout.order() == order);
        CHECK(back.storage.encoding == encoding);
        CHECK(!back.original);
        CHECK(!back.file_indices);
        const StreamingResult expected = golden(view, packing.stored), got = golden(view, back);
        REQUIRE(expected.stats.contributors > 1000);
        CHECK(same_pictures(got.frame.image, expected.frame.image));
        CHECK(got.frame.transmittance == expected.frame.transmittance);
        CHECK(got.frame.contributors == expected.frame.contributors);
        CHECK(std::memcmp(&got.stats, &expected.stats, sizeof got.stats) == 0);
        if (order == kChunks) {
          CHECK(back.tree().depth == packing.stored.tree().depth);
          CHECK(back.tree().chunk_count == packing.stored.tree().chunk_count);
        }
        CHECK(same_pictures(render_reference(view, back.decoded).image,
                            render_reference(view, packing.stored.decoded).image));
      }
    }
  }
}

TEST_CASE("restore: an empty scene") {
  for (const StorageOrder order : kStorageOrders) {
    const Packing packing = make_packing(ActivatedCloud{}, SecondHalfEncoding::kRaw, order);
    const StoredScene back = restore_scene(packing.packed(), "scene.sgs");
    CHECK(back.decoded.size() == 0);
    CHECK(golden(small_view(), back).stats.contributors == 0);
  }
}

// A change of an image's bytes that no builder makes.
struct Change {
  SecondHalfEncoding encoding;
  StorageOrder order;
  const char* says;
  std::function<void(PackedScene&)> make;
};

template <class T>
T get(const PackedScene& packed, std::uint64_t address) {
  T value;
  std::memcpy(&value, packed.image.bytes.data() + address, sizeof value);
  return value;
}
template <class T>
void put(PackedScene& packed, std::uint64_t address, T value) {
  std::memcpy(packed.image.bytes.data() + address, &value, sizeof value);
}
template <class Record, class Alter>
void alter(PackedScene& packed, std::uint64_t address, Alter&& how) {
  auto record = get<Record>(packed, address);
  how(record);
  put(packed, address, record);
}

void check_refused(const std::vector<Change>& changes) {
  const ActivatedCloud cloud = cut_object(400, 1);
  for (const Change& change : changes) {
    PackedScene packed = make_packing(cloud, change.encoding, change.order).packed();
    change.make(packed);
    INFO(change.says);
    CHECK_THAT(input_error_of([&] { restore_scene(packed, "scene.sgs"); }),
               Contains("scene.sgs: ") && Contains(change.says));
  }
}

TEST_CASE("restore: records that nothing encodes are refused") {
  using P = PackedScene;
  constexpr auto kRaw = SecondHalfEncoding::kRaw;
  const auto half = [](P& p) { return p.image.layout.second_halves.address(5); };
  const auto first = [](P& p) { return p.image.layout.first_halves.address(5); };
  check_refused({
      {kRaw, kChunks, "slot 5: centre: got (nan", [&](P& p) { put(p, first(p), NAN); }},
      {kRaw, kVoxels, "slot 5: centre: got (inf", [&](P& p) { put(p, first(p), INFINITY); }},
      {kRaw, kChunks, "centre: got (2e+18", [&](P& p) { put(p, first(p), 2e18F); }},
      {kRaw, kVoxels, "scales", [&](P& p) { put(p, first(p) + 12, -1.0F); }},
      {kRaw, kVoxels, "scales: the largest is 1", [&](P& p) { put(p, half(p), 1.0F); }},
      // By chunks: the largest scale, two scales, quaternion, opacity.
      {kRaw, kChunks, "scales", [&](P& p) { put(p, half(p), -1.0F); }},
      {kRaw, kChunks, "expected 0 to 10000000", [&](P& p) { put(p, half(p), 2e7F); }},
      {kRaw, kChunks, "scales", [&](P& p) { put(p, half(p), INFINITY); }},
      {kRaw, kChunks, "scales", [&](P& p) { put(p, half(p) + 4, 1e30F); }},
      {kRaw, kChunks, "rotation", [&](P& p) { put(p, half(p) + 12, 2.0F); }},
      {kRaw, kChunks, "rotation", [&](P& p) { put(p, half(p) + 16, NAN); }},
      {kRaw, kChunks, "opacity: got 1.5", [&](P& p) { put(p, half(p) + 28, 1.5F); }},
      // The code of its extents: a scale of 2^-8, and the scale as it was with extents of nought.
      {kRaw, kChunks, "visible extents: got", [&](P& p) { put(p, first(p) + 12, 0U); }},
      {kRaw, kChunks, "visible extents: got",
       [&](P& p) { put(p, first(p) + 12, get<std::uint32_t>(p, first(p) + 12) | 0xffffff00U); }},
      {kRaw, kFile, "slot 5: centre: got (nan", [&](P& p) { put(p, first(p), NAN); }},
      {kRaw, kVoxels, "opacity: got nan", [&](P& p) { put(p, half(p) + 24, NAN); }},
      {kRaw, kVoxels, "SH coefficient 3", [&](P& p) { put(p, half(p) + 72, INFINITY); }},
      {kRaw, kVoxels, "SH coefficient 3", [&](P& p) { put(p, half(p) + 72, -2e18F); }},
      // Both signs set: the largest scale has no axis.
      {kRaw, kVoxels, "nan), expected 0 to 10000000",
       [&](P& p) { put(p, half(p), 0xbc000000bc000000U); }},
      {SecondHalfEncoding::kHalf, kVoxels, "nan), expected 0 to 10000000",
       [&](P& p) { put(p, half(p), 0xa000a000U); }},
      {SecondHalfEncoding::kHalf, kVoxels, "rotation",
       [&](P& p) { put(p, half(p) + 4, std::uint64_t{0}); }},
      {SecondHalfEncoding::kHalf, kVoxels, "SH coefficient 0",
       [&](P& p) { put(p, half(p) + 14, std::uint16_t{0x7c00}); }},
      {SecondHalfEncoding::kHalf, kVoxels, "scales",
       [&](P& p) { put(p, half(p), std::uint16_t{0x4000}); }},
  });
}

TEST_CASE("restore: indices beyond a codebook, and codebooks of what is none") {
  using P = PackedScene;
  constexpr auto kVq = SecondHalfEncoding::kVq, kVqPacked = SecondHalfEncoding::kVqPacked;
  const auto half = [](P& p) { return p.image.layout.second_halves.address(5); };
  const auto entry = [](P& p, Codebook codebook) {
    const SceneLayout& layout = p.image.layout;
    return layout.codebooks.base + layout.second_half.entry(codebook, 2).begin;
  };
  check_refused({
      {kVq, kChunks, "slot 5: index into codebook scale: got 21, expected less than 21",
       [&](P& p) { put(p, half(p) + 4, 21U); }},
      {kVq, kVoxels, "codebook rotation: got 4294967295", [&](P& p) { put(p, half(p) + 4, ~0U); }},
      {kVq, kVoxels, "codebook sh: got 9", [&](P& p) { put(p, half(p) + 12, 9U); }},
      // 5 + 6 + 5 + 4 bits behind the opacity.
      {kVqPacked, kChunks, "codebook scale: got 31",
       [&](P& p) { put(p, half(p) + 5, std::uint8_t{0x1f}); }},
      {kVqPacked, kVoxels, "codebook", [&](P& p) { put(p, half(p), ~0U); }},
      {kVq, kChunks, "codebook scale: entry 2: word 0: got 1.25",
       [&](P& p) { put(p, entry(p, Codebook::kScale), 1.25F); }},
      {kVq, kChunks, "codebook scale: entry 2",
       [&](P& p) { put(p, entry(p, Codebook::kScale) + 4, -0.5F); }},
      {kVq, kChunks, "codebook rotation: entry 2: got (7",
       [&](P& p) { put(p, entry(p, Codebook::kRotation), 7.0F); }},
      {kVq, kVoxels, "codebook dc: entry 2: word 1: got nan",
       [&](P& p) { put(p, entry(p, Codebook::kDc) + 4, NAN); }},
      {kVq, kVoxels, "codebook sh: entry 2: word 8: got inf",
       [&](P& p) { put(p, entry(p, Codebook::kSh) + 32, INFINITY); }},
  });
}

TEST_CASE("restore: voxel tables that lead astray are refused") {
  using P = PackedScene;
  constexpr auto kRaw = SecondHalfEncoding::kRaw;
  const auto node = [](std::uint32_t n, auto&& how) {
    return [=](P& p) { alter<VoxelNode>(p, p.image.layout.voxel_table().nodes.address(n), how); };
  };
  const auto voxel = [](std::uint32_t v, auto&& how) {
    return
        [=](P& p) { alter<VoxelRecord>(p, p.image.layout.voxel_table().voxels.address(v), how); };
  };
  check_refused({
      {kRaw, kVoxels, "node 0", node(0, [](VoxelNode& n) { n.occupied = 0; })},
      {kRaw, kVoxels, "node 0", node(0, [](VoxelNode& n) { n.occupied = ~std::uint64_t{0}; })},
      {kRaw, kVoxels, "node 0", node(0, [](VoxelNode& n) { n.first_child = 0xffffffff; })},
      {kRaw, kVoxels, "node 1", node(1, [](VoxelNode& n) { n.first_child += 1; })},
      {kRaw, kVoxels, "voxel 0", voxel(0, [](VoxelRecord& r) { r.first = 1; })},
      {kRaw, kVoxels, "voxel 3", voxel(3, [](VoxelRecord& r) { r.count = 0; })},
      {kRaw, kVoxels, "voxel 3", voxel(3, [](VoxelRecord& r) { r.count = 0xffffffff; })},
      {kRaw, kVoxels, "voxel 4", voxel(3, [](VoxelRecord& r) { ++r.count; })},
      {kRaw, kVoxels, "along axis 1, expected",
       [](P& p) { ++std::get<VoxelTableLayout>(p.image.layout.table).frame.origin_cell.y; }},
      {kRaw, kVoxels, "in slot 0: got cell",
       [](P& p) { put(p, p.image.layout.first_halves.address(0), 1e6F); }},
  });
}

TEST_CASE("restore: chunk tables that lead astray are refused") {
  using P = PackedScene;
  constexpr auto kRaw = SecondHalfEncoding::kRaw;
  const auto node = [](std::uint32_t n, auto&& how) {
    return [=](P& p) { alter<ChunkNode>(p, p.image.layout.chunk_table().nodes.address(n), how); };
  };
  // The root's children are nodes, the last node's are chunks.
  const auto last = [](auto&& how) {
    return [=](P& p) {
      const RecordArray& nodes = p.image.layout.chunk_table().nodes;
      alter<ChunkNode>(p, nodes.address(nodes.count - 1), how);
    };
  };
  check_refused({
      {kRaw, kChunks, "node 0: got 9 children", node(0, [](ChunkNode& n) { n.children = 9; })},
      {kRaw, kChunks, "node 0: got 0 children", node(0, [](ChunkNode& n) { n.children = 0; })},
      {kRaw, kChunks, "node 0: got node 0", node(0, [](ChunkNode& n) { n.first_node = 0; })},
      {kRaw, kChunks, "as a child", node(0, [](ChunkNode& n) { n.first_node = 0xfffffff0; })},
      {kRaw, kChunks, "no parent", node(0, [](ChunkNode& n) { n.first_node = 2; })},
      {kRaw, kChunks, "got a chunk of", last([](ChunkNode& n) { n.first_slot = 0xfffffff0; })},
      {kRaw, kChunks, "got a chunk of 17", last([](ChunkNode& n) { n.count[0] = 17; })},
      {kRaw, kChunks, "in another chunk too", last([](ChunkNode& n) { n.first_slot = 0; })},
      {kRaw, kChunks, "leaves out a Gaussian", last([](ChunkNode& n) { n.high[0][0] = 0; })},
      {kRaw, kChunks, "leaves out a Gaussian", node(0, [](ChunkNode& n) { n.extent[0][1] = 0; })},
      {kRaw, kChunks, "leaves out a Gaussian", node(0, [](ChunkNode& n) { n.scale[0] = 0; })},
      {kRaw, kChunks, "leaves out a Gaussian", node(0, [](ChunkNode& n) { n.origin[0] = NAN; })},
      {kRaw, kChunks, "Gaussians in",
       [](P& p) { ++std::get<ChunkTableLayout>(p.image.layout.table).chunk_count; }},
      {kRaw, kChunks, "expected at most 4", [](P& p) { p.storage.chunk_gaussians = 4; }},
  });
}

TEST_CASE("restore: random changes are refused or can be rendered") {
  const View<float> view = small_view();
  const ActivatedCloud cloud = cut_object(200, 1);
  std::mt19937 random(7);
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      const PackedScene packed = make_packing(cloud, encoding, order).packed();
      std::vector<Region> regions;
      for (const Region& region : packed.image.layout.regions) {
        if (region.bytes > 0) regions.push_back(region);
      }
      int refused = 0, rendered = 0;
      for (int round = 0; round < 50; ++round) {
        PackedScene changed = packed;
        const Region& region = regions[below(regions.size())];
        changed.image.bytes[region.base + below(region.bytes)] ^=
            static_cast<std::byte>(std::size_t{1} << below(8));
        try {
          golden(view, restore_scene(changed, "scene.sgs"));
          ++rendered;
        } catch (const InputError&) {
          ++refused;
        }
      }
      CAPTURE(static_cast<int>(order), static_cast<int>(encoding));
      CHECK(refused > 0);
      CHECK(rendered > 0);
    }
  }
}

}  // namespace
}  // namespace sgs::test
