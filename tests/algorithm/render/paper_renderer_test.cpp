// The streaming renderer in paper order, and the same visits in right order, against a renderer
// that takes each pixel by itself; the counts of what the order loses against a count over all
// pairs.
#include "algorithm/render/paper_renderer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/render/paper_losses.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/make_splat.h"
#include "testbench/builtin/open_scene.h"
#include "tests/algorithm/voxel/stored_clouds.h"

namespace sgs {
namespace {

struct Pixel {
  glm::vec3 colour{0.0F};
  float transmittance = 1;
  std::uint32_t blended = 0;
  std::uint64_t misordered = 0;
};

// Section 3 of the rendering semantics for one pixel.
Pixel render_pixel(int x, int y, const std::vector<Splat>& splats) {
  Pixel pixel;
  float deepest = 0;
  for (const Splat& s : splats) {
    const SubtileRect& f = s.footprint;
    if (x / 4 < f.x0 || x / 4 >= f.x1 || y / 4 < f.y0 || y / 4 >= f.y1) continue;
    // Relative to the sub-tile's corner first: the order of these subtractions decides the last
    // bit.
    const float dx = s.x - static_cast<float>(x / 4 * 4) - static_cast<float>(x % 4);
    const float dy = s.y - static_cast<float>(y / 4 * 4) - static_cast<float>(y % 4);
    const float alpha = alpha_at(s.conic_a, s.conic_b, s.conic_c, s.opacity, dx, dy);
    if (alpha == 0) continue;
    const float weight = alpha * pixel.transmittance;
    const float after = pixel.transmittance - weight;
    if (after < static_cast<float>(kTransmittanceMin)) break;
    for (int c = 0; c < 3; ++c) pixel.colour[c] += s.rgb[c] * weight;
    pixel.transmittance = after;
    ++pixel.blended;
    pixel.misordered += s.depth < deepest ? 1 : 0;
    deepest = std::max(deepest, s.depth);
  }
  return pixel;
}

struct Counts {
  std::uint64_t missed = 0, misordered = 0, contributors = 0;
};

// Every Gaussian tested against every group; no coarse filter, no early end of a group. in_order:
// the same splats by depth.
Counts render_slowly(const View<float>& view, const ActivatedCloud& cloud, const VoxelGrid& grid,
                     const PixelSize& group_size, Image& image, Image& in_order) {
  Counts counts;
  std::vector<std::uint32_t> voxel_of(cloud.size(), ~0U);
  for (std::uint32_t v = 0; v < grid.voxels.size(); ++v) {
    for (std::uint32_t k = 0; k < grid.voxels[v].count; ++k) {
      voxel_of[grid.voxels[v].first + k] = v;
    }
  }
  OrderingTable table(grid.voxels.size());
  for (const PixelRect& group : pixel_groups(view.width, view.height, group_size)) {
    const GroupVisits visits = paper_visits(view, group, grid, {}, table);
    std::vector<std::vector<Splat>> of_voxel(grid.voxels.size());
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      Splat splat{};
      if (voxel_of[i] == ~0U || !make_geometry(view, cloud.gaussians[i], splat) ||
          !reaches_group(splat, group)) {
        continue;
      }
      add_colour(view, cloud.sh_degree, cloud.gaussians[i].mean, cloud.sh(i), splat);
      splat.index = i;
      of_voxel[voxel_of[i]].push_back(splat);
    }
    std::vector<Splat> sequence;
    for (const std::uint32_t voxel : visits.voxels) {
      std::sort(of_voxel[voxel].begin(), of_voxel[voxel].end(), in_front);
      sequence.insert(sequence.end(), of_voxel[voxel].begin(), of_voxel[voxel].end());
      of_voxel[voxel].clear();
    }
    for (const auto& left : of_voxel) counts.missed += left.size();
    std::vector<Splat> by_depth = sequence;
    std::sort(by_depth.begin(), by_depth.end(), in_front);
    for (int y = group.y0; y < group.y1; ++y) {
      for (int x = group.x0; x < group.x1; ++x) {
        in_order.at(x, y) = render_pixel(x, y, by_depth).colour;
        const Pixel pixel = render_pixel(x, y, sequence);
        image.at(x, y) = pixel.colour;
        counts.misordered += pixel.misordered;
        counts.contributors += pixel.blended;
      }
    }
  }
  return counts;
}

void check_against_slow(const char* spec, float voxel_size, const PixelSize& group, int width_px,
                        int height_px) {
  const Scene scene = open_scene(spec);
  const auto [cloud, grid] = test::by_voxels(activate(scene.cloud), voxel_size);
  std::uint64_t missed = 0, misordered = 0;
  for (const Camera& camera : scene.cameras) {
    const View<float> view = make_view<float>(scaled_to(camera, width_px, height_px));
    Image slow(width_px, height_px), slow_in_order = slow;
    const Counts counts = render_slowly(view, cloud, grid, group, slow, slow_in_order);
    PaperOrderConfig config;
    config.group = group;
    const StreamingResult result = render_paper_order(view, cloud, grid, config);
    INFO(spec << " voxel " << voxel_size << " group " << group.width << " x " << group.height
              << " camera " << camera.id);
    CHECK(std::memcmp(result.frame.image.pixels.data(), slow.pixels.data(),
                      slow.pixels.size() * sizeof(glm::vec3)) == 0);
    const Image in_order =
        render_visited_in_order(view, cloud, grid, group, result.group_voxels, config.background);
    CHECK(std::memcmp(in_order.pixels.data(), slow_in_order.pixels.data(),
                      slow_in_order.pixels.size() * sizeof(glm::vec3)) == 0);
    CHECK(result.stats.missed == counts.missed);
    CHECK(result.stats.misordered == counts.misordered);
    CHECK(result.stats.contributors == counts.contributors);
    missed += counts.missed;
    misordered += counts.misordered;
  }
  CHECK(misordered > 0);
  CHECK(missed > 0);
}

TEST_CASE("paper renderer: picture, missed and misordered as counted pixel by pixel, object") {
  check_against_slow("builtin:object?n=3000", 0.4F, {16, 16}, 96, 54);
  check_against_slow("builtin:object?n=3000", 0.4F, {64, 64}, 96, 54);
  check_against_slow("builtin:object?n=3000", 0.1F, {4, 64}, 50, 37);
}

TEST_CASE("paper renderer: picture, missed and misordered as counted pixel by pixel, outdoor") {
  check_against_slow("builtin:outdoor?n=3000", 2.0F, {40, 24}, 96, 54);
}

TEST_CASE("paper renderer: one voxel that holds all is the reference image") {
  const Scene scene = open_scene("builtin:object?n=3000");
  ActivatedCloud in_file = activate(scene.cloud);
  // Away from the origin, where eight voxels would meet.
  constexpr float kAway = 500;
  for (Gaussian<float>& g : in_file.gaussians) g.mean += kAway;
  const auto [cloud, grid] = test::by_voxels(in_file, 4096.0F);
  REQUIRE(grid.voxels.size() == 1);
  for (Camera camera : scene.cameras) {
    camera.position += kAway;
    const View<float> view = make_view<float>(scaled_to(camera, 128, 72));
    const RenderResult reference = render_reference(view, cloud);
    const StreamingResult result = render_paper_order(view, cloud, grid, {});
    CHECK(result.frame.image.pixels == reference.image.pixels);
    CHECK(
        render_visited_in_order(view, cloud, grid, square_of(64), result.group_voxels, {}).pixels ==
        reference.image.pixels);
    CHECK(result.stats.misordered == 0);
    CHECK(result.stats.contributors > 1000);
  }
}

TEST_CASE("paper renderer: parts of a group change no pixel in single precision") {
  const Scene scene = open_scene("builtin:object?n=3000");
  const auto [cloud, grid] = test::by_voxels(activate(scene.cloud), 0.4F);
  const View<float> view = make_view<float>(scaled_to(scene.cameras.front(), 97, 53));
  PaperOrderConfig config;
  config.group = {48, 96};  // sub-tiles that two, three and four parts divide
  const StreamingResult whole = render_paper_order(view, cloud, grid, config);
  CHECK(whole.stats.fine_tests == whole.stats.second_halves);
  CHECK(whole.stats.coarse_passed == whole.stats.second_halves);
  for (const std::uint32_t parts : {4U, 9U, 16U}) {
    INFO(parts);
    config.parts = parts;
    const StreamingResult cut = render_paper_order(view, cloud, grid, config);
    CHECK(cut.frame.image.pixels == whole.frame.image.pixels);
    CHECK(cut.stats.contributors == whole.stats.contributors);
    CHECK(cut.stats.misordered == whole.stats.misordered);
    // A second half is fetched once for all parts that want it.
    CHECK(cut.stats.second_halves <= whole.stats.second_halves);
    CHECK(cut.stats.coarse_passed == cut.stats.second_halves);
    CHECK(cut.stats.fine_tests > cut.stats.second_halves);
    CHECK(cut.stats.fine_tests < parts * cut.stats.second_halves);
  }
}

}  // namespace
}  // namespace sgs
