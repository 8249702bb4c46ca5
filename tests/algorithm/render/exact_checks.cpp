// Comparison of exact order with the reference renderer.
#include "tests/algorithm/render/exact_checks.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/voxel/hard_scenes.h"
#include "tests/algorithm/voxel/stored_clouds.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {

std::string first_difference(const RenderResult& got, const RenderResult& expected) {
  for (std::size_t i = 0; i < expected.image.pixels.size(); ++i) {
    // Bits, not values: also a zero's sign and colours that are no numbers.
    const bool same =
        std::memcmp(&got.image.pixels[i], &expected.image.pixels[i], sizeof(glm::vec3)) == 0 &&
        std::memcmp(&got.transmittance[i], &expected.transmittance[i], sizeof(float)) == 0 &&
        got.contributors[i] == expected.contributors[i];
    if (same) continue;
    const auto width = static_cast<std::size_t>(expected.image.width);
    return fmt::format("pixel ({}, {}): {} contributors, T {}, red {}; expected {}, {}, {}",
                       i % width, i / width, got.contributors[i], got.transmittance[i],
                       got.image.pixels[i].x, expected.contributors[i], expected.transmittance[i],
                       expected.image.pixels[i].x);
  }
  return {};
}

std::string difference_from_reference(const View<float>& view, const ActivatedCloud& cloud,
                                      const ChunkTree& tree, const ExactOrderConfig& config) {
  return first_difference(render_exact_order(view, cloud, tree, config).frame,
                          render_reference(view, cloud, config.background));
}

void fuzz_exact_order(unsigned first_seed, unsigned scenes) {
  std::uint64_t contributors = 0, saved = 0;
  for (unsigned seed = first_seed; seed < first_seed + scenes; ++seed) {
    HardScenes hard(seed);
    constexpr std::size_t kCounts[] = {0, 1, 30, 300, 2000};
    const HardScene scene = hard.next(kCounts[hard.pick(5)], hard.pick(20) == 0 ? 1 : 160);
    const auto chunk = static_cast<std::uint32_t>(1 + hard.pick(hard.pick(2) == 0 ? 16 : 256));
    const auto [cloud, tree] = by_chunks(activate(scene.cloud), chunk,
                                         hard.pick(2) == 0 ? Stored::kVisible : Stored::kAll);
    ExactOrderConfig config;
    config.group = {4 * (1 + hard.pick(50)), 4 * (1 + hard.pick(50))};
    config.merge_entries = static_cast<std::uint32_t>(2 + hard.pick(100));
    config.walk_room = {std::size_t(9 + hard.pick(60)), std::size_t(9 + hard.pick(60))};
    config.background = {0.25F, 0.5F, 1};
    const View<float> view = make_view<float>(scene.camera);
    const StreamingResult exact = render_exact_order(view, cloud, tree, config);
    const RenderResult reference = render_reference(view, cloud, config.background);
    const std::string difference = first_difference(exact.frame, reference);
    if (!difference.empty()) FAIL("seed " << seed << ": " << difference);
    if (exact.stats.misordered != 0) FAIL("seed " << seed << ": blended out of order");
    contributors += exact.stats.contributors;
    saved += cloud.size() * exact.stats.groups - exact.stats.first_halves;
  }
  fmt::print("{} blends over {} scenes, {} first halves left out\n", contributors, scenes, saved);
  CHECK(contributors > 1000 * std::uint64_t{scenes});
  CHECK(saved > 0);
}

void check_exact_on_shared(const std::string& name) {
  const auto cameras = read_view_cameras(shared_path("cameras/" + name + ".json")).cameras;
  const ActivatedCloud cloud = activate(read_ply(shared_scene(name)).cloud);
  ExactOrderConfig shipped;
  shipped.group = square_of(128);
  ExactOrderConfig small;
  small.group = square_of(32);
  small.merge_entries = 64;
  small.walk_room = {24, 24};
  const auto of_16 = by_chunks(cloud, 16), of_100 = by_chunks(cloud, 100);
  for (const Camera& camera : cameras) {
    CAPTURE(name, camera.id);
    const View<float> view = make_view<float>(camera);
    CHECK(difference_from_reference(view, of_16.cloud, of_16.table, shipped) == "");
    CHECK(difference_from_reference(view, of_100.cloud, of_100.table, small) == "");
  }
}

}  // namespace sgs::test
