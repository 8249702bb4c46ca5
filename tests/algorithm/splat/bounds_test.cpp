// The bounds of footprint.h, coarse_bound.h and extent_bound.h never remove a pixel
// whose computed alpha is visible: seeded random Gaussians, needles of ratio 10^10, giants and the
// near plane among them.
#include <catch2/catch.hpp>
#include <vector>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/row_span.h"
#include "algorithm/splat/visible_extents.h"
#include "tests/algorithm/splat/random_gaussian.h"

using namespace sgs;

namespace {

PixelRect frame_of(const View<float>& view) { return {0, 0, view.width, view.height}; }

// alpha as blend() computes it, sub-tile by sub-tile.
float computed_alpha(const Projected<float>& p, float opacity, int x, int y) {
  const float left = p.x - static_cast<float>(x / kSubtilePx * kSubtilePx);
  const float top = p.y - static_cast<float>(y / kSubtilePx * kSubtilePx);
  return alpha_at(p.conic_a, p.conic_b, p.conic_c, opacity,
                  left - static_cast<float>(x % kSubtilePx),
                  top - static_cast<float>(y % kSubtilePx));
}

// The square of side px that holds the pixel, cut to the frame.
PixelRect block_of(const View<float>& view, int x, int y, int side) {
  const int x0 = x / side * side, y0 = y / side * side;
  return intersection(PixelRect{x0, y0, x0 + side, y0 + side}, frame_of(view));
}

bool holds(const SubtileRect& footprint, int x, int y) {
  return x / kSubtilePx >= footprint.x0 && x / kSubtilePx < footprint.x1 &&
         y / kSubtilePx >= footprint.y0 && y / kSubtilePx < footprint.y1;
}

struct Counts {
  int drawn = 0;         // Gaussians with a visible pixel
  int ill = 0;           // of those, with a condition beyond the ellipse bound
  long visible_px = 0;   // pixels with alpha > 0
  long kept = 0;         // 4x4 blocks of the footprint that `reaches` keeps
  long hit = 0;          // of those, with a visible pixel
  long spanned = 0;      // of the footprint's, in the spans of their rows
  long coarse_kept = 0;  // Gaussians that the coarse bound keeps in the frame
  long extent_kept = 0;  // and the bound on extents
  long sides_kept = 0;   // and the frame's sides
};

// Bounds of each row of sub-tiles of a footprint.
std::vector<RowBounds<float>> rows_of(const Projected<float>& p, float opacity,
                                      const SubtileRect& footprint) {
  Splat splat{};
  splat.x = p.x;
  splat.y = p.y;
  splat.conic_a = p.conic_a;
  splat.conic_b = p.conic_b;
  splat.conic_c = p.conic_c;
  splat.opacity = opacity;
  RowSpans<float> spans(splat);
  spans.start(footprint.y0 * kSubtilePx);
  std::vector<RowBounds<float>> rows;
  for (int y = footprint.y0; y < footprint.y1; ++y) {
    rows.push_back(spans.next(y * kSubtilePx, (y + 1) * kSubtilePx));
  }
  return rows;
}

void fail(const char* bound, const Projected<float>& p, float opacity, int x, int y) {
  CAPTURE(x, y, p.x, p.y, p.cov_a, p.cov_b, p.cov_c, p.determinant, p.radius, opacity);
  FAIL("a visible pixel is removed by " << bound);
}

bool reached(const ExtentBound& bound, const PixelRect& block, int x, int y) {
  const PixelRect group{block.x0 / kSubtilePx * kSubtilePx, block.y0 / kSubtilePx * kSubtilePx,
                        block.x1, block.y1};
  const GroupReach reach = group_reach(bound, group);
  const int column = (x - group.x0) / kSubtilePx, row = (y - group.y0) / kSubtilePx;
  return column >= reach.x0 && column <= reach.x1 && row >= reach.y0 && row <= reach.y1;
}

void check_gaussian(const View<float>& view, const Gaussian<float>& g, Counts& counts) {
  const float scale_max = std::max({g.scale.x, g.scale.y, g.scale.z});
  const CoarseBound bound = coarse_bound(view, g.mean, scale_max);
  const auto v = to_camera(view, g.mean);
  REQUIRE(bound.in_front == (v.z > 0.2F));
  if (!bound.in_front) return;
  // As it is stored.
  const VisibleExtents known = decode_extents(encode_extents(visible_extents(g)));
  const ExtentBound by_extents = extent_bound(view, g.mean, known.extent, known.scale_max);
  REQUIRE(by_extents.in_front);
  REQUIRE(by_extents.depth == bound.depth);
  counts.coarse_kept += touches(bound, frame_of(view));
  counts.extent_kept += touches(by_extents, frame_of(view));
  const bool beside = !may_touch_frame(view, frame_sides(view), g.mean, scale_max);
  counts.sides_kept += !beside;
  const auto p = project(view, g, v);
  const PixelRect tiles = tile_rect(p.x, p.y, p.radius, view.width, view.height);
  const SubtileRect cut = footprint(p, g.opacity, view.width, view.height);
  const float cutoff = visible_cutoff(g.opacity);
  const PixelRect pixels = intersection(
      PixelRect{tiles.x0 * kTilePx, tiles.y0 * kTilePx, tiles.x1 * kTilePx, tiles.y1 * kTilePx},
      frame_of(view));
  const std::vector<RowBounds<float>> rows = rows_of(p, g.opacity, cut);
  bool drawn = false;
  const auto columns = static_cast<std::size_t>(view.width / kSubtilePx + 1);
  const auto subtile = [&](int x, int y) { return static_cast<std::size_t>(y) * columns + x; };
  std::vector<char> hit(columns * static_cast<std::size_t>(view.height / kSubtilePx + 1), 0);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      if (!(computed_alpha(p, g.opacity, x, y) > 0)) continue;
      drawn = true;
      ++counts.visible_px;
      hit[subtile(x / kSubtilePx, y / kSubtilePx)] = 1;
      if (beside) fail("the frame's sides", p, g.opacity, x, y);
      if (!holds(cut, x, y)) fail("the footprint", p, g.opacity, x, y);
      const auto row = rows[static_cast<std::size_t>(y / kSubtilePx - cut.y0)];
      const auto column = static_cast<float>(x);
      if (!(column >= row.low && column <= row.high)) fail("its row's span", p, g.opacity, x, y);
      for (const int side : {1, 4, 16, 64}) {
        const PixelRect block = block_of(view, x, y, side);
        if (!reaches(p.x, p.y, p.conic_a, p.conic_b, p.conic_c, cutoff, block)) {
          fail("reaches()", p, g.opacity, x, y);
        }
        if (!touches(bound, block)) fail("the coarse bound", p, g.opacity, x, y);
        if (!touches(by_extents, block)) fail("the extents", p, g.opacity, x, y);
        if (!reached(by_extents, block, x, y)) fail("the group's reach", p, g.opacity, x, y);
      }
    }
  }
  if (!drawn) return;
  ++counts.drawn;
  const float trace = p.cov_a + p.cov_c;
  const bool ill = !(ellipse_widening(trace * trace / p.determinant) < kMaxWidening);
  counts.ill += ill;
  if (ill) return;
  for (int y = cut.y0; y < cut.y1; ++y) {
    const auto row = rows[static_cast<std::size_t>(y - cut.y0)];
    for (int x = cut.x0; x < cut.x1; ++x) {
      const auto first = static_cast<float>(x * kSubtilePx);
      counts.spanned += first + kSubtilePx - 1 >= row.low && first <= row.high ? 1 : 0;
      if (!reaches(p.x, p.y, p.conic_a, p.conic_b, p.conic_c, cutoff,
                   block_of(view, x * kSubtilePx, y * kSubtilePx, kSubtilePx))) {
        continue;
      }
      ++counts.kept;
      counts.hit += hit[subtile(x, y)];
    }
  }
}

void run(unsigned seed, double skew) {
  test::RandomGaussians random(seed, 83, 51);  // px, no multiples of the tile
  Counts counts;
  for (int c = 0; c < 40; ++c) {
    Camera camera = random.camera();
    camera.world_from_camera[0] *= 1 + skew;
    camera.world_from_camera[1] += skew * camera.world_from_camera[0];
    const auto view = make_view<float>(camera);
    for (int i = 0; i < 1000; ++i) check_gaussian(view, random.gaussian(camera), counts);
  }
  CAPTURE(counts.drawn, counts.ill, counts.visible_px, counts.kept, counts.hit, counts.spanned,
          counts.coarse_kept, counts.extent_kept, counts.sides_kept);
  // The test has seen what it is for, and the bounds are of use: most of what they keep is visible.
  CHECK(counts.drawn > 10000);
  CHECK(counts.ill > 300);
  CHECK(static_cast<double>(counts.hit) > 0.8 * static_cast<double>(counts.kept));
  CHECK(static_cast<double>(counts.hit) > 0.8 * static_cast<double>(counts.spanned));
  CHECK(counts.drawn > counts.coarse_kept / 2);
  CHECK(counts.extent_kept < counts.coarse_kept);
  CHECK(static_cast<double>(counts.sides_kept) < 1.25 * static_cast<double>(counts.coarse_kept));
}

}  // namespace

TEST_CASE("bounds hold on 40,000 random Gaussians") { run(20, 0); }

TEST_CASE("bounds hold for a camera whose rotation is one within 10^-3 only", "[nightly]") {
  run(21, 1e-3);
}

TEST_CASE("the footprint holds the tips of needles to the last visible pixel") {
  // The pixel under test is the last of its sub-tile on the far side, so that a box short of it by
  // any amount leaves its sub-tile out.
  test::RandomGaussians random(22, 4096, 4096);
  long tips = 0;
  for (int i = 0; i < 20000; ++i) {
    const Camera camera = random.camera();
    const auto view = make_view<float>(camera);
    Gaussian<float> g = random.gaussian(camera);
    g.opacity = 0.2F;  // visible to 2.80 sigma, inside the square of the tiles
    const auto v = to_camera(view, g.mean);
    if (!(v.z > 0.2F)) continue;
    const float longest = static_cast<float>(random.log_uniform(20, 150) * v.z / camera.focal_x);
    g.scale = {longest, longest * 1e-6F, longest * 1e-6F};
    const auto at_origin = project(view, g, v);
    const double half = std::sqrt(2 * std::log(255 * 0.2) * at_origin.cov_a);
    const double lean = at_origin.cov_b / at_origin.cov_a;
    if (at_origin.radius < half + 2) continue;  // nearly upright: the tiles may cut it
    for (const int side : {-1, 1}) {
      const int x = side < 0 ? 2003 : 2000, y = 2000 + random.pick(4);
      for (double t = 1.02; t > 0.98; t -= 1e-4) {
        Projected<float> p = at_origin;
        p.x = static_cast<float>(x - side * half * t);
        p.y = static_cast<float>(y - side * half * lean * t);
        if (!(computed_alpha(p, g.opacity, x, y) > 0)) continue;
        ++tips;
        if (!holds(footprint(p, g.opacity, 4096, 4096), x, y)) fail("tip", p, g.opacity, x, y);
        break;
      }
    }
  }
  CHECK(tips > 20000);
}
