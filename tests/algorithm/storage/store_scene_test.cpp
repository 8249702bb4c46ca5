// Storing by configuration: what is asked for is stored, and what was left open is chosen by rule.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_scene.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/storage/packed_scenes.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

bool same_gaussians(const ActivatedCloud& a, const ActivatedCloud& b) {
  return a.size() == b.size() &&
         std::memcmp(a.gaussians.data(), b.gaussians.data(), a.size() * sizeof a.gaussians[0]) == 0;
}

TEST_CASE("store: every encoding in every order, with and without what nobody can see") {
  const ActivatedCloud cloud = cut_object(300, 2);
  const std::size_t visible = stored_gaussians(cloud, Stored::kVisible).size();
  REQUIRE(visible < 300);
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      for (const bool invisible : {false, true}) {
        CAPTURE(static_cast<int>(order), static_cast<int>(encoding), invisible);
        StorageConfig config = small_storage(encoding, order);
        config.store_invisible = invisible;
        config.chunk_gaussians = 5;
        const StoredScene scene = store_scene(cloud, config, {});
        const SceneLayout& layout = scene.image.layout;
        CHECK(scene.gaussians == 300);
        CHECK(layout.gaussian_count() == (invisible ? 300 : visible));
        CHECK(layout.order() == order);
        CHECK(layout.second_half.encoding == encoding);
        CHECK(layout.sh_degree() == 2);
        CHECK(scene.image.bytes.size() == layout.stored_bytes);
        CHECK(scene.storage.store_invisible == invisible);
        const SecondHalfFormat widest = config.widest_format(2);
        for (std::size_t id = 0; id < kCodebookCount; ++id) {
          CHECK(layout.second_half.entries[id] <= widest.entries[id]);
          CHECK((layout.second_half.entries[id] > 0) == (widest.entries[id] > 0));
        }
        if (order == StorageOrder::kChunks) {
          CHECK(layout.chunk_table().chunk_count == scene.tree().chunk_count);
          CHECK(scene.tree().chunk_count >= layout.gaussian_count() / 5);
        } else if (order == StorageOrder::kVoxels) {
          CHECK(layout.voxel_table().frame.voxel_size == 0.4F);
        }
        // Every cloud is in storage order.
        REQUIRE(scene.file_indices);
        CHECK(scene.file_indices->size() == layout.gaussian_count());
        const ActivatedCloud expected = reordered(cloud, *scene.file_indices);
        // The original is kept where it is not what the units decode.
        const bool lossy = encoding != SecondHalfEncoding::kRaw;
        REQUIRE(scene.original.has_value() == lossy);
        CHECK(same_gaussians(lossy ? *scene.original : scene.decoded, expected));
        CHECK(same_gaussians(scene.decoded, expected) == !lossy);
        std::vector<std::uint32_t> once = *scene.file_indices;
        std::sort(once.begin(), once.end());
        CHECK(once == stored_gaussians(cloud, stored_of(config)));
      }
    }
  }
}

TEST_CASE("store: cameras weigh codebooks, whose making is told") {
  const ActivatedCloud cloud = cut_object(300, 1);
  const std::vector<Camera> cameras = make_builtin_scene("builtin:object?n=8").cameras;
  for (const SecondHalfEncoding encoding : kEncodings) {
    CAPTURE(static_cast<int>(encoding));
    const StorageConfig config = small_storage(encoding, StorageOrder::kChunks);
    std::size_t told = 0;
    const StoredScene weighed =
        store_scene(cloud, config, cameras, [&](Codebook, std::uint32_t, double) { ++told; });
    const StoredScene even = store_scene(cloud, config, {});
    const bool quantised = weighed.image.layout.second_half.quantised();
    CHECK((told > 0) == quantised);
    CHECK((weighed.image.bytes == even.image.bytes) == !quantised);
  }
}

TEST_CASE("store: by file as the scene's file has them, or as chunks of close ones would be") {
  const ActivatedCloud cloud = cut_object(300, 1);
  StorageConfig config = small_storage(SecondHalfEncoding::kRaw, StorageOrder::kFile);
  config.sequence = FileSequence::kFile;
  const StoredScene in_file = store_scene(cloud, config, {});
  CHECK(in_file.file_indices == stored_gaussians(cloud, Stored::kVisible));
  config.sequence = FileSequence::kSpatial;
  const StoredScene spatial = store_scene(cloud, config, {});
  CHECK(spatial.file_indices != in_file.file_indices);
  CHECK(spatial.file_indices == arrange_by_chunks(cloud, 16).storage_order);
  CHECK(spatial.image.layout.order() == StorageOrder::kFile);
  CHECK(scheme_of(StorageOrder::kFile).in_words(config) == "neighbours together");
}

// The bound against colours themselves, from everywhere.
TEST_CASE("store: bands that change no colour by more than the tolerance are not stored") {
  ActivatedCloud cloud = cut_object(60, 3);
  for (std::size_t i = 0; i < cloud.sh_coeffs.size(); ++i) {
    if (i % 16 > 8) cloud.sh_coeffs[i] *= 0.002F;
    if (i % 16 == 2) cloud.sh_coeffs[i] = glm::vec3(0.5F);  // of degree 1
  }
  for (const SecondHalfEncoding encoding : kEncodings) {
    StorageConfig config = small_storage(encoding, StorageOrder::kChunks);
    config.sh_tolerance = 1.0 / 510;
    const ShBands bands = bands_to_store(cloud, config);
    REQUIRE(bands.degree < 3);
    REQUIRE(bands.degree > 0);
    CHECK(bands.most_error <= config.sh_tolerance);
    const StoredScene scene = store_scene(cloud, config, {});
    CHECK(scene.image.layout.sh_degree() == bands.degree);
    CHECK(scene.sh_bands_left_out == 3 - bands.degree);
    CHECK(scene.sh_error == bands.most_error);
    CHECK(scene.original->sh_degree == 3);
    const ActivatedCloud cut = with_bands(cloud, bands.degree);
    double worst = 0;
    for (int at = 0; at < 400; ++at) {
      const float z = 1 - (2 * static_cast<float>(at) + 1) / 400, angle = 2.4F * at;
      const float across = std::sqrt(1 - z * z);
      const glm::vec3 offset(across * std::cos(angle), across * std::sin(angle), z);
      for (const std::uint32_t i : stored_gaussians(cloud, Stored::kVisible)) {
        const glm::vec3 change =
            sh_colour(3, cloud.sh(i), offset) - sh_colour(bands.degree, cut.sh(i), offset);
        for (int channel = 0; channel < 3; ++channel) {
          worst = std::max(worst, double{std::abs(change[channel])});
        }
      }
    }
    constexpr double kRounding = 1e-6;
    CHECK(worst <= bands.most_error + kRounding);
    CHECK(worst >= 0.3 * bands.most_error);  // no more cautious than that
    config.sh_tolerance = 0.5 * bands.most_error;
    CHECK(bands_to_store(cloud, config).degree > bands.degree);
    config.sh_tolerance = 0;
    CHECK(store_scene(cloud, config, {}).image.layout.sh_degree() == 3);
  }
}

TEST_CASE("store: sizes that are still to be chosen are refused") {
  const ActivatedCloud cloud = cut_object(20, 0);
  const auto refusal = [&](StorageOrder order, double voxel_size, std::uint32_t chunk_gaussians) {
    StorageConfig config = small_storage(SecondHalfEncoding::kRaw, order);
    config.voxel_size = voxel_size;
    config.chunk_gaussians = chunk_gaussians;
    return input_error_of([&] { store_scene(cloud, config, {}); });
  };
  CHECK_THAT(refusal(StorageOrder::kVoxels, 0, 16), Contains("voxel_size: got 0"));
  CHECK_THAT(refusal(StorageOrder::kVoxels, 1e-60, 16), Contains("voxel_size: got 1e-60"));
  CHECK_THAT(refusal(StorageOrder::kVoxels, 1e-7, 16), Contains("at least"));
  CHECK_THAT(refusal(StorageOrder::kChunks, 1, 0), Contains("chunk_gaussians: got 0"));
}

TEST_CASE("storage choices: voxels by the scene's extent, chunks by a row of memory") {
  ActivatedCloud cloud = cut_object(2000, 0);
  const auto spread = [&](float factor) {
    for (Gaussian<float>& g : cloud.gaussians) g.mean *= factor;
  };
  spread(9.9F / inner_extent(cloud));
  const Choice<double> small = choose_voxel_size(cloud);
  CHECK(small.value == 0.4);
  CHECK_THAT(small.why, Contains("small") && Contains("within 9.9") && Contains("at most 10"));
  spread(10.2F / 9.9F);
  const Choice<double> real = choose_voxel_size(cloud);
  CHECK(real.value == 2);
  CHECK_THAT(real.why, Contains("real") && Contains("within 10.2") && Contains("more than 10"));
  // As it is said, whatever the extent.
  CHECK(choose_voxel_size(cloud, VoxelRule::kSynthetic).value == 0.4);
  CHECK(choose_voxel_size(cut_object(10, 0), VoxelRule::kReal).value == 2);

  for (const auto& [run_bytes, gaussians] : {std::pair<std::uint32_t, std::uint32_t>{256, 16},
                                             {4096, 64},
                                             {512, 32},
                                             {40, 2},
                                             {8, 1},
                                             {0, 1}}) {
    const Choice<std::uint32_t> chunk = choose_chunk_gaussians(run_bytes);
    CHECK(chunk.value == gaussians);
    CHECK_THAT(chunk.why, Contains(std::to_string(gaussians) + " first halves of 16 B") &&
                              Contains(std::to_string(run_bytes) + " B that lie together"));
  }
}

}  // namespace
}  // namespace sgs::test
