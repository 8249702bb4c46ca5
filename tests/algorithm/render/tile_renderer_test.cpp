// The tile-centric renderer gives the reference image bit for bit where its boxes reach what is
// visible and its numbers are floats; what each approximation costs by itself.
#include "algorithm/render/tile_renderer.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/coarse_bound.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/render/exact_checks.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/voxel/hard_scenes.h"

using namespace sgs;

namespace {

// Of boxes: with every test and bitmap; and by the square of 3 sigma alone, which is the
// reference's own.
std::vector<TileOrderConfig> lossless_configs() {
  std::vector<TileOrderConfig> configs;
  for (const TileTest test : {TileTest::kBox, TileTest::kOriented}) {
    for (const int across : {1, 2, 4}) {
      configs.push_back(TileOrderConfig::lossless());
      configs.back().rules.test = test;
      configs.back().rules.subtiles_across = across;
    }
  }
  configs.push_back(TileOrderConfig::lossless());
  configs.back().rules = {TileReach::kThreeSigma, TileTest::kBox, 1};
  return configs;
}

void check_lossless(const View<float>& view, const ActivatedCloud& cloud,
                    const TileOrderConfig& config) {
  CAPTURE(static_cast<int>(config.rules.test), config.rules.subtiles_across);
  CHECK(test::first_difference(render_tiles(view, cloud, config).frame,
                               render_reference(view, cloud, config.background)) == "");
}

struct Listed {
  std::uint32_t key, index, bitmap;
  Splat splat;
};

// Every Gaussian against every tile of the frame.
std::vector<std::vector<Listed>> all_lists(const View<float>& view, const ActivatedCloud& cloud,
                                           const TileRules& rules, NumberFormat keys,
                                           TileStats& stats) {
  const int columns = (view.width + 15) / 16, rows = (view.height + 15) / 16;
  std::vector<std::vector<Listed>> lists(static_cast<std::size_t>(columns * rows));
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    ++stats.gaussians;
    const float largest = std::max({g.scale.x, g.scale.y, g.scale.z});
    if (!may_touch_frame(view, frame_sides(view), g.mean, largest)) {
      ++stats.culled;
      continue;
    }
    Listed entry{0, i, 0, {}};
    TileBoxes boxes;
    if (!make_tile_geometry(view, g, rules, entry.splat, boxes)) continue;
    entry.key = depth_key(keys, entry.splat.depth);
    bool any = false;
    for (int tile = 0; tile < columns * rows; ++tile) {
      const int x = tile % columns, y = tile / columns;
      if (x < boxes.tiles.x0 || x >= boxes.tiles.x1 || y < boxes.tiles.y0 || y >= boxes.tiles.y1) {
        continue;
      }
      ++stats.tile_tests;
      entry.bitmap = tile_bitmap(boxes, rules, x, y);
      for (int part = 0; part < rules.subtiles_across * rules.subtiles_across; ++part) {
        ++stats.subtile_tests;
        stats.parts += entry.bitmap >> part & 1U;
      }
      if (entry.bitmap == 0) continue;
      lists[static_cast<std::size_t>(tile)].push_back(entry);
      any = true;
      ++stats.pairs;
    }
    stats.projected += any ? 1 : 0;
  }
  return lists;
}

struct Pixel {
  float light = 1, deepest = 0;
  bool finished = false;
};

// Whether the splat is blended into the pixel, one at a time.
bool blend_pixel(const Splat& splat, int x, int y, Pixel& pixel, TileStats& stats) {
  if (pixel.finished) return false;
  const float alpha = alpha_at(splat.conic_a, splat.conic_b, splat.conic_c, splat.opacity,
                               splat.x - static_cast<float>(x), splat.y - static_cast<float>(y));
  if (alpha == 0) return false;
  const float after = pixel.light - alpha * pixel.light;
  if (after < 1e-4F) {
    pixel.finished = true;
    return false;
  }
  pixel.light = after;
  ++stats.contributors;
  stats.misordered += splat.depth < pixel.deepest ? 1 : 0;
  pixel.deepest = std::max(pixel.deepest, splat.depth);
  return true;
}

// A tile's list, pixel by pixel; those outside of the frame are finished from the start.
void count_tile(const View<float>& view, const TileOrderConfig& config, int tile_x, int tile_y,
                std::vector<Listed> list, std::set<std::uint32_t>& contributing, TileStats& stats) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Listed& a, const Listed& b) { return a.key < b.key; });
  Pixel pixels[16][16];
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      pixels[y][x].finished = tile_x * 16 + x >= view.width || tile_y * 16 + y >= view.height;
    }
  }
  const auto unfinished = [&](int x0, int y0, int width, int height) {
    for (int y = y0; y < y0 + height; ++y) {
      for (int x = x0; x < x0 + width; ++x) {
        if (!pixels[y][x].finished) return true;
      }
    }
    return false;
  };
  const int across = config.rules.subtiles_across, part_px = 16 / across;
  std::size_t taken = 0;
  for (; taken < list.size() && unfinished(0, 0, 16, 16); ++taken) {
    const Listed& entry = list[taken];
    const auto in_part = [&](int x, int y) {
      return (entry.bitmap >> (y / part_px * across + x / part_px) & 1U) != 0;
    };
    for (int y = 0; y < 16; y += 4) {
      for (int x = 0; x < 16; x += 4) {
        stats.subtile_blends += in_part(x, y) && unfinished(x, y, 4, 4) ? 1 : 0;
      }
    }
    for (int y = 0; y < 16; y += 2) {  // a warp has two rows
      stats.warp_entries += unfinished(0, y, 16, 2) ? 1 : 0;
      bool blended = false;
      for (int at = 0; at < 32; ++at) {
        const int x = at % 16, row = y + at / 16;
        if (!in_part(x, row)) continue;
        blended |=
            blend_pixel(entry.splat, tile_x * 16 + x, tile_y * 16 + row, pixels[row][x], stats);
      }
      stats.warp_blends += blended ? 1 : 0;
      if (blended) contributing.insert(entry.index);
    }
  }
  stats.list_max = std::max<std::uint64_t>(stats.list_max, list.size());
  stats.entries_taken += taken;
  for (std::size_t first = 0; first < list.size(); first += config.chunk_entries) {
    ++stats.chunks;
    if (first >= taken) continue;
    ++stats.chunks_taken;
    stats.chunk_entries_taken += std::min<std::size_t>(config.chunk_entries, list.size() - first);
  }
  stats.tiles_finished += unfinished(0, 0, 16, 16) ? 0 : 1;
}

}  // namespace

TEST_CASE("tile-centric equals the reference: random hard scenes") {
  const std::vector<TileOrderConfig> configs = lossless_configs();
  std::uint64_t contributors = 0, spared = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    test::HardScenes hard(seed);
    constexpr std::size_t kCounts[] = {0, 1, 30, 300, 2000};
    const test::HardScene scene = hard.next(kCounts[hard.pick(5)], hard.pick(20) == 0 ? 1 : 160);
    const ActivatedCloud cloud = activate(scene.cloud);
    const View<float> view = make_view<float>(scene.camera);
    const TileOrderConfig& config =
        configs[static_cast<std::size_t>(hard.pick(static_cast<int>(configs.size())))];
    CAPTURE(seed);
    check_lossless(view, cloud, config);
    const TileStats stats = render_tiles(view, cloud, config).stats;
    contributors += stats.contributors;
    spared += stats.tile_tests - stats.pairs;
  }
  CHECK(contributors > 1000000);
  CHECK(spared > 1000);
}

TEST_CASE("tile-centric equals the reference: needles across the frame", "[nightly]") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    GaussianCloud cloud = test::random_cloud(seed, 300, 0, {0, 0, 3}, 3, 0.1F, 1.0F);
    for (auto& scales : cloud.log_scales) {
      scales = {std::log(0.8F), std::log(0.8F) - 0.2F * static_cast<float>(seed), std::log(1e-3F)};
    }
    for (float& logit : cloud.opacity_logits) logit = 3;
    for (const TileOrderConfig& config : lossless_configs()) {
      CAPTURE(seed);
      check_lossless(make_view<float>(test::forward_camera(200, 150, 150)), activate(cloud),
                     config);
    }
  }
}

TEST_CASE("tile-centric: what each approximation costs by itself on built-in scenes", "[nightly]") {
  struct Approximation {
    const char* name;
    std::function<void(TileOrderConfig&)> make;
    double at_least_db;
  };
  const Approximation approximations[] = {
      {"oriented boxes of 3 sigma",
       [](TileOrderConfig& c) {
         c.rules = {TileReach::kThreeSigma, TileTest::kOriented, 1};
       },
       70},
      {"parts of tiles by boxes of 3 sigma",
       [](TileOrderConfig& c) {
         c.rules = {TileReach::kThreeSigma, TileTest::kBox, 2};
       },
       70},
      {"features in half", [](TileOrderConfig& c) { c.features = NumberFormat::kHalf; }, 65},
      {"keys in half", [](TileOrderConfig& c) { c.keys = NumberFormat::kHalf; }, 43},
      {"blending in half", [](TileOrderConfig& c) { c.precision = BlendPrecision::kHalf; }, 57},
      {"pixels in fixed point", [](TileOrderConfig& c) { c.precision = BlendPrecision::kFixed; },
       67},
      {"all of them", [](TileOrderConfig& c) { c = TileOrderConfig{}; }, 43},
  };
  for (const std::string spec : {"builtin:object?n=20000", "builtin:outdoor?n=40000"}) {
    const BuiltinScene scene = make_builtin_scene(spec);
    const ActivatedCloud cloud = activate(scene.cloud);
    const View<float> view = make_view<float>(scene.cameras[0]);
    const Image reference = render_reference(view, cloud, glm::vec3(0)).image;
    for (const TileOrderConfig& config : lossless_configs()) check_lossless(view, cloud, config);
    for (const Approximation& approximation : approximations) {
      TileOrderConfig config = TileOrderConfig::lossless();
      approximation.make(config);
      const double db = psnr_db(render_tiles(view, cloud, config).frame.image, reference);
      UNSCOPED_INFO(fmt::format("{}: {} {:.2f} dB", spec, approximation.name, db));
      CHECK(db > approximation.at_least_db);
      CHECK(std::isfinite(db));  // it does change something
    }
  }
}

TEST_CASE("tile-centric: every count, by a loop over pixels") {
  constexpr int kWidth = 100, kHeight = 70;  // neither is whole tiles
  GaussianCloud scene = test::random_cloud(5, 9000, 0, {0, 0, 4}, 3, 0.02F, 0.9F);
  for (float& logit : scene.opacity_logits) logit += 3;  // some tiles finish
  for (int i = 0; i < 20; ++i) test::add_ball(scene, {0, 0, -2}, 0.1, 0.5, {1, 1, 1});
  const ActivatedCloud cloud = activate(scene);
  const View<float> view = make_view<float>(test::forward_camera(kWidth, kHeight, 80));
  for (const int across : {1, 2, 4}) {
    CAPTURE(across);
    // Numbers as the loop has them; keys in half so that some are blended out of order.
    TileOrderConfig config = TileOrderConfig::lossless();
    config.rules.subtiles_across = across;
    config.keys = NumberFormat::kHalf;
    config.chunk_entries = 16;
    TileStats want;
    std::set<std::uint32_t> contributing;
    const auto lists = all_lists(view, cloud, config.rules, config.keys, want);
    constexpr int kColumns = (kWidth + 15) / 16;
    for (std::size_t tile = 0; tile < lists.size(); ++tile) {
      count_tile(view, config, static_cast<int>(tile) % kColumns, static_cast<int>(tile) / kColumns,
                 lists[tile], contributing, want);
    }
    want.contributing = contributing.size();
    const TileStats got = render_tiles(view, cloud, config).stats;
    constexpr std::pair<const char*, std::uint64_t TileStats::*> kCounts[] = {
        {"gaussians", &TileStats::gaussians},
        {"culled", &TileStats::culled},
        {"projected", &TileStats::projected},
        {"tile_tests", &TileStats::tile_tests},
        {"subtile_tests", &TileStats::subtile_tests},
        {"pairs", &TileStats::pairs},
        {"parts", &TileStats::parts},
        {"list_max", &TileStats::list_max},
        {"entries_taken", &TileStats::entries_taken},
        {"chunks", &TileStats::chunks},
        {"chunks_taken", &TileStats::chunks_taken},
        {"chunk_entries_taken", &TileStats::chunk_entries_taken},
        {"tiles_finished", &TileStats::tiles_finished},
        {"subtile_blends", &TileStats::subtile_blends},
        {"contributors", &TileStats::contributors},
        {"warp_entries", &TileStats::warp_entries},
        {"warp_blends", &TileStats::warp_blends},
        {"contributing", &TileStats::contributing},
        {"misordered", &TileStats::misordered}};
    for (const auto& [name, count] : kCounts) {
      CAPTURE(name);
      CHECK(want.*count > 0);
      CHECK(got.*count == want.*count);
    }
    CHECK(want.entries_taken < want.pairs);
  }
}
