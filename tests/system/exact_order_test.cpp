// Exact order through the whole accelerator: the reference image whatever the configuration, every
// byte computed a second time, and what the report says of it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/render/group_state.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/visible_extents.h"
#include "algorithm/voxel/chunk_test.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/voxel/stored_clouds.h"
#include "tests/system/exact_order_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

// What a frame needs when no group ever finishes early, counted over the tree without a queue, a
// cache or a clock.
struct Counts {
  std::uint64_t visits = 0, nodes = 0, first_halves = 0, second_halves = 0;
};

void count_below(const View<float>& view, const ActivatedCloud& cloud, const ChunkTree& tree,
                 const PixelRect& group, std::uint32_t at, Counts& counts) {
  ++counts.nodes;
  const ChunkNode& node = tree.nodes[at];
  std::uint32_t slot = node.first_slot, inner = node.first_node;
  for (int c = 0; c < node.children; ++c) {
    const bool touching = GroupFrustum(view, group).test(child_bound(node, c)).touches;
    const std::uint32_t count = node.count[c];
    if (count == 0) {
      if (touching) count_below(view, cloud, tree, group, inner, counts);
      ++inner;
      continue;
    }
    counts.visits += touching ? 1 : 0;
    counts.first_halves += touching ? count : 0;
    for (std::uint32_t i = slot; touching && i < slot + count; ++i) {
      const Gaussian<float>& g = cloud.gaussians[i];
      const VisibleExtents known = decode_extents(encode_extents(visible_extents(g)));
      const ExtentBound bound = extent_bound(view, g.mean, known.extent, known.scale_max);
      counts.second_halves += bound.in_front && touches(bound, group) ? 1 : 0;
    }
    slot += count;
  }
}

Counts count_frame(const Camera& camera, const ActivatedCloud& cloud, const ChunkTree& tree,
                   const PixelSize& group_size) {
  const View<float> view = make_view<float>(camera);
  Counts counts;
  for (const PixelRect& group : pixel_groups(camera.width, camera.height, group_size)) {
    count_below(view, cloud, tree, group, 0, counts);
  }
  return counts;
}

TEST_CASE("exact frames: hard scenes under random configurations") { fuzz_exact_frames(0, 40); }

TEST_CASE("exact frames: bytes are counts times sizes, counted without the accelerator") {
  const BuiltinScene scene = make_builtin_scene("builtin:outdoor?n=6000");
  const ActivatedCloud in_file = activate(scene.cloud);
  const Camera camera = scaled_to(scene.cameras[2], 150, 90);
  constexpr std::uint64_t kSecondHalf = 224, kNode = 128;
  for (const std::uint32_t chunk : {1U, 16U, 100U}) {
    for (const PixelSize group : {PixelSize{16, 16}, {64, 64}, {80, 20}}) {
      INFO("chunk " << chunk << ", group " << group.width << " x " << group.height);
      const auto [cloud, tree] = by_chunks(in_file, chunk);
      const Counts counts = count_frame(camera, cloud, tree, group);
      const Arguments arguments =
          with_settings({"builtin:outdoor?n=6000", "--size", "150x90", "--view", "2"},
                        {"rendering.saturation_feedback=false",
                         "storage.chunk_gaussians=" + std::to_string(chunk),
                         "group_width_px=" + std::to_string(group.width),
                         "group_height_px=" + std::to_string(group.height),
                         "sram.shared_bytes=1073741824", "vsu.upper_nodes=5"});
      const Simulation roomy(with_settings(
          arguments,
          {"merge.entries=100000", "vsu.queue_entries=100000", "vsu.node_queue_entries=100000"}));
      roomy.check();
      const Json& view = roomy.views()[0];
      CHECK(counter(view, "vsu", "visits") == counts.visits);
      CHECK(region_bytes(view, "first_halves", "read") == 16 * counts.first_halves);
      CHECK(region_bytes(view, "second_halves", "read") == kSecondHalf * counts.second_halves);
      CHECK(counter(view, "merge", "released") == counts.second_halves);
      CHECK(region_bytes(view, "frame_buffer", "write") == 150 * 90 * 12);
      CHECK(region_bytes(view, "spill", "write") == 0);
      CHECK(region_bytes(view, "spill", "read") == 0);
      CHECK(counter(view, "vsu", "nodes") == counts.nodes);
      // Each node, for each group that it touches, but for the first ones: those once.
      const std::uint64_t opened_on_chip = counter(view, "vsu", "upper_nodes_opened");
      CHECK(opened_on_chip > 0);
      CHECK(counter(view, "vsu", "nodes_read") + opened_on_chip == counts.nodes);
      const std::uint64_t upper = std::min<std::uint64_t>(5, tree.nodes.size());
      CHECK(region_bytes(view, "chunk_table", "read") ==
            kNode * (upper + counter(view, "vsu", "nodes_read")));

      const Simulation tight(with_settings(
          arguments, {"merge.entries=32", "vsu.queue_entries=9", "vsu.node_queue_entries=9"}));
      tight.check();
      CHECK(tight.frame(0) == roomy.frame(0));
      const Json& small = tight.views()[0];
      CHECK(region_bytes(small, "first_halves", "read") == 16 * counts.first_halves);
      CHECK(region_bytes(small, "second_halves", "read") == kSecondHalf * counts.second_halves);
      const std::uint64_t spilled = counter(small, "merge", "keys_spilled");
      CHECK((spilled > 0) == (chunk > 1));  // one key a visit waits for nothing
      CHECK(asked_bytes(small, "spill", "merge", "write") == 32 * spilled);
      CHECK(asked_bytes(small, "spill", "merge", "read") == 32 * spilled);
      const std::uint64_t aside = counter(small, "vsu", "queue_entries_put_aside");
      CHECK(asked_bytes(small, "spill", "vsu", "write") == 16 * aside);
      CHECK(asked_bytes(small, "spill", "vsu", "read") == 16 * aside);
      // Nothing but those regions: a tie costs no byte.
      for (const auto& [region, traffic] : small["dram"]["bytes_by_region"].items()) {
        INFO(region);
        CHECK((region == "chunk_table" || region == "first_halves" || region == "second_halves" ||
               region == "spill" || region == "frame_buffer"));
      }
    }
  }
}

TEST_CASE("exact frames: equal depths are counted, and cost nothing") {
  GaussianCloud cloud;
  cloud.resize(500, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto at = static_cast<float>(i);
    cloud.means[i] = {0.3F * std::sin(at), 0.3F * std::cos(3 * at), 2 + 0.01F * at};
    cloud.log_scales[i] = glm::vec3(-4);
    cloud.quats[i] = {1, 0, 0, 0};
  }
  Camera camera;
  camera.width = camera.height = 64;
  camera.focal_x = camera.focal_y = 80;
  const ScratchFolder scratch;
  write_ply(scratch.path("scene.ply"), cloud);
  write_cameras(scratch.path("cameras.json"), {camera});
  const Arguments arguments = {scratch.path("scene.ply"), "--cameras", scratch.path("cameras.json"),
                               "--set", "rendering.saturation_feedback=false"};
  const Simulation none(arguments);
  none.check();
  CHECK(counter(none.views()[0], "merge", "ties") == 0);

  // Each of 500 depths twice, the second time far away in the file.
  GaussianCloud twice = cloud;
  twice.means.insert(twice.means.end(), cloud.means.begin(), cloud.means.end());
  twice.log_scales.insert(twice.log_scales.end(), cloud.log_scales.begin(), cloud.log_scales.end());
  twice.quats.insert(twice.quats.end(), cloud.quats.begin(), cloud.quats.end());
  twice.opacity_logits.resize(1000);
  twice.sh_coeffs.resize(1000, glm::vec3(0.5F));
  write_ply(scratch.path("scene.ply"), twice);
  const Simulation pairs(arguments);
  pairs.check();
  const Json& view = pairs.views()[0];
  CHECK(2 * counter(view, "merge", "ties") == counter(view, "merge", "released"));
  CHECK(counter(view, "merge", "released") == 2 * counter(none.views()[0], "merge", "released"));
}

// Gaussians at one point, faint, of five sizes and several colours.
GaussianCloud at_one_point(std::size_t count) {
  GaussianCloud cloud;
  cloud.resize(count, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.means[i] = {0.01F, 0.02F, 2};
    cloud.log_scales[i] = glm::vec3(-2 - static_cast<float>(i % 5));
    cloud.quats[i] = {1, 0, 0, 0};
    cloud.opacity_logits[i] = -5;
    cloud.sh_coeffs[i] = glm::vec3(static_cast<float>(i % 7), static_cast<float>(i % 3), 1);
  }
  return cloud;
}

Camera small_camera() {
  Camera camera;
  camera.width = 40;
  camera.height = 30;
  camera.focal_x = camera.focal_y = 50;
  return camera;
}

// As many depths as Gaussians, in a cube: the chunks lie beside and behind each other.
GaussianCloud at_many_depths(std::size_t count) {
  GaussianCloud cloud = at_one_point(count);
  const auto shuffled = [&](std::size_t i, std::size_t step) {
    return 0.7F * static_cast<float>(i * step % count) / static_cast<float>(count);
  };
  for (std::size_t i = 0; i < count; ++i) {
    cloud.means[i] +=
        glm::vec3(shuffled(i, 31) - 0.35F, shuffled(i, 617) - 0.35F, shuffled(i, 7919));
  }
  return cloud;
}

TEST_CASE("exact frames: what is spilled grows little faster than the keys") {
  const ScratchFolder scratch;
  write_cameras(scratch.path("cameras.json"), {small_camera()});
  for (GaussianCloud (*make)(std::size_t) : {&at_one_point, &at_many_depths}) {
    std::vector<double> writes_a_key;
    for (const std::size_t keys : {2000U, 16000U}) {
      write_ply(scratch.path("scene.ply"), make(keys));
      const Simulation simulation(
          with_settings({scratch.path("scene.ply"), "--cameras", scratch.path("cameras.json")},
                        {"merge.entries=16", "rendering.saturation_feedback=false"}));
      simulation.check();
      writes_a_key.push_back(
          static_cast<double>(counter(simulation.views()[0], "merge", "keys_spilled")) /
          static_cast<double>(keys));
    }
    CHECK(writes_a_key[0] > 2);  // far more than fits: most are merged, and merged again
    CHECK(writes_a_key[1] < 2.5 * writes_a_key[0]);
    CHECK(writes_a_key[1] < 20);
  }
}

TEST_CASE("exact frames: blend_early is lossy where the buffer is small, and says so") {
  const Arguments arguments =
      with_settings({"builtin:outdoor?n=8000", "--size", "160x90"},
                    {"group_width_px=64", "group_height_px=64", "merge.on_overflow=blend_early"});
  const Simulation early(with_settings(arguments, {"merge.entries=16"}));
  const Json& view = early.views()[0];
  CHECK(view["image"]["equals_streaming_renderer"] == true);
  CHECK(counter(view, "merge", "forced_early") > 0);
  CHECK(view["image"]["misordered"].get<std::uint64_t>() > 0);
  CHECK(view["image"]["max_abs_error"].get<double>() > 0);
  CHECK(view["image"]["psnr_db"].get<double>() > 15);
  CHECK(counter(view, "merge", "runs_spilled") == 0);
  CHECK(region_bytes(view, "spill", "write") == 0);

  const Simulation enough(with_settings(arguments, {"sram.shared_bytes=0", "merge.entries=5000"}));
  enough.check();  // the reference image
  CHECK(counter(enough.views()[0], "merge", "forced_early") == 0);
}

TEST_CASE("exact frames: blend_early without the coarse filter, whose keys are others") {
  for (const char* entries : {"16", "64", "150"}) {
    INFO(entries);
    const Arguments arguments =
        with_settings({"builtin:outdoor?n=4000", "--size", "160x90"},
                      {"group_width_px=64", "group_height_px=64", "merge.on_overflow=blend_early",
                       std::string("merge.entries=") + entries});
    const Simulation with(arguments);
    const Simulation without(with_settings(arguments, {"hfu.coarse_filter=false"}));
    const Json &filtered = with.views()[0], &all = without.views()[0];
    CHECK(all["image"]["equals_streaming_renderer"] == true);
    CHECK(filtered["image"]["equals_streaming_renderer"] == true);
    CHECK(counter(all, "merge", "forced_early") > counter(filtered, "merge", "forced_early"));
    CHECK(without.frame(0) != with.frame(0));
  }
}

TEST_CASE("exact frames: the least that a frame could read") {
  const Simulation simulation({"builtin:object?n=2000", "--size", "80x45"});
  const Json& view = simulation.views()[0];
  // Once each: what contributes, and the pixels.
  const std::uint64_t once =
      view["limit"]["contributing_gaussians"].get<std::uint64_t>() * (16 + 224) + 80 * 45 * 12;
  CHECK(view["limit"]["bytes_read_once"] == once);
  CHECK(view["limit"]["ratio"].get<double>() ==
        Approx(view["dram"]["bytes"].get<double>() / static_cast<double>(once)));
}

}  // namespace
}  // namespace sgs::test
