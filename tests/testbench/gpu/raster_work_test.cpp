// The counts of the original's work beside a loop over pixels.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/projection.h"
#include "testbench/gpu/gpu_model.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {
namespace {

struct Listed {
  Splat splat;
  PixelRect tiles;
};

std::vector<Listed> listed_of(const View<float>& view, const ActivatedCloud& cloud) {
  std::vector<Listed> out;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Listed listed;
    Projected<float> p;
    if (!make_geometry(view, cloud.gaussians[i], listed.splat, p)) continue;
    listed.splat.index = static_cast<std::uint32_t>(i);
    listed.tiles = tile_rect(p.x, p.y, p.radius, view.width, view.height);
    out.push_back(listed);
  }
  std::sort(out.begin(), out.end(),
            [](const Listed& a, const Listed& b) { return in_front(a.splat, b.splat); });
  return out;
}

struct Walk {
  std::uint64_t warp_entries = 0, warp_blends = 0, blends = 0, entries = 0;
};

// 16 x 2 px, every thread by itself, in step over the list of its tile.
void walk_warp(const View<float>& view, const std::vector<Splat>& list, int left, int top,
               Walk& sum, std::size_t& walked) {
  std::vector<float> transmittance(32, 1);
  std::vector<bool> done(32);
  for (int t = 0; t < 32; ++t) {
    done[static_cast<std::size_t>(t)] = left + t % 16 >= view.width || top + t / 16 >= view.height;
  }
  for (std::size_t e = 0; e < list.size(); ++e) {
    if (std::count(done.begin(), done.end(), true) == 32) return;
    const Splat& s = list[e];
    ++sum.warp_entries;
    walked = std::max(walked, e + 1);
    bool any = false;
    for (std::size_t t = 0; t < 32; ++t) {
      if (done[t]) continue;
      const float dx = s.x - static_cast<float>(left + static_cast<int>(t) % 16);
      const float dy = s.y - static_cast<float>(top + static_cast<int>(t) / 16);
      const float alpha = alpha_at(s.conic_a, s.conic_b, s.conic_c, s.opacity, dx, dy);
      if (alpha == 0) continue;
      const float behind = transmittance[t] * (1 - alpha);
      if (behind < 1e-4F) {
        done[t] = true;
        continue;
      }
      transmittance[t] = behind;
      any = true;
      ++sum.blends;
    }
    sum.warp_blends += any ? 1 : 0;
  }
}

TEST_CASE("work of the original rasteriser: as a loop over pixels counts it") {
  constexpr std::size_t kBatch = 256;
  int ended_early = 0;  // tiles with a whole batch that nobody fetches
  for (unsigned seed = 0; seed < 12; ++seed) {
    const GaussianCloud parameters =
        random_cloud(seed, 40 + 60 * seed, static_cast<int>(seed % 4), {0, 0, 3}, 2, 0.02F, 0.8F);
    ActivatedCloud cloud = activate(parameters);
    if (seed % 3 == 2) {  // so that tiles are finished before their lists are
      for (Gaussian<float>& g : cloud.gaussians) {
        g.opacity = 0.99F;
        g.scale *= 3.0F;
      }
    }
    const Camera camera = forward_camera(53, 37, 40);
    const View<float> view = make_view<float>(camera);
    const RasterWork work = count_raster_work(view, cloud);
    const std::vector<Listed> listed = listed_of(view, cloud);
    Walk walk;
    std::uint64_t pairs = 0, tiles = 0, fetched = 0;
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 4; ++x) {
        std::vector<Splat> list;
        for (const Listed& l : listed) {
          const PixelRect& r = l.tiles;
          if (x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1) list.push_back(l.splat);
        }
        pairs += list.size();
        ++tiles;
        std::size_t walked = 0;
        for (int w = 0; w < 8; ++w) walk_warp(view, list, 16 * x, 16 * y + 2 * w, walk, walked);
        const std::size_t batches = (walked + kBatch - 1) / kBatch * kBatch;
        fetched += std::min(list.size(), batches);
        ended_early += batches < list.size() ? 1 : 0;
      }
    }
    CAPTURE(seed);
    CHECK(work.gaussians == cloud.size());
    CHECK(work.listed == listed.size());
    CHECK(work.in_front >= work.listed);
    CHECK(work.pairs == pairs);
    CHECK(work.tiles == tiles);
    CHECK(work.pixels == 53U * 37U);
    CHECK(work.warp_entries == walk.warp_entries);
    CHECK(work.warp_blends == walk.warp_blends);
    CHECK(work.blends == walk.blends);
    CHECK(work.pair_steps * 32 >= pairs);
    CHECK(work.entries_fetched == fetched);
  }
  CHECK(ended_early > 0);
}

}  // namespace
}  // namespace sgs::test
