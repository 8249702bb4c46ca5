// Interval blending in the order of float.
#include "tests/algorithm/render/pixel_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/make_splat.h"
#include "testbench/oracle/double_oracle.h"
#include "tests/algorithm/render/tracked_projection.h"

namespace sgs::test {
namespace {

constexpr double kRoundoff = 0x1p-24;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct TrackedSplat {
  Tracked x, y, opacity, rgb[3];
  Log2Conic<Tracked> conic;
  PixelRect tiles;
  float depth;
  std::uint32_t index;
};

// 2^t of exp2.h: 1.1 units in the last place, nothing below 2^-125.
Tracked exp2_tracked(Tracked t) {
  const double value = std::exp2(std::min(t.value, 64.0));
  const double carried = value * std::expm1(std::min(t.error, 128.0) * std::log(2.0));
  return {value, carried + 1.1 * 0x1p-23 * (value + carried) + 0x1p-125};
}

Tracked hull(Tracked a, Tracked b) {
  const double low = std::min(a.low(), b.low()), high = std::max(a.high(), b.high());
  if (!(high - low < kInfinity)) return {a.value, kInfinity};
  return {(low + high) / 2, (high - low) / 2};
}

// Of one pixel, front to back.
class Blending {
 public:
  bool finished() const { return finished_; }
  Tracked colour(int channel) const { return colour_[channel]; }
  Tracked transmittance() const { return t_; }

  void blend(const TrackedSplat& s, int x, int y) {
    const Tracked exponent = log2_falloff(s.conic, offset(s.x, x), offset(s.y, y));
    Tracked alpha = min_of(s.opacity * exp2_tracked(exponent), constant<Tracked>(kAlphaMax));
    if (!(alpha.error < 1)) alpha = {0.5, 0.5};
    const double least = kAlphaMin * (1 - 2 * kRoundoff), most = kAlphaMin * (1 + 2 * kRoundoff);
    if (alpha.high() < least || exponent.low() > 0) return;
    const bool surely = alpha.low() > most && exponent.high() <= 0;

    // t - alpha t: t's own error shrinks with it.
    const Tracked weight = alpha * t_;
    Tracked after =
        after_rounding(t_.value - alpha.value * t_.value,
                       t_.error * (1 - std::max(0.0, alpha.low())) + t_.value * alpha.error +
                           alpha.error * t_.error + kRoundoff * (weight.value + weight.error));
    const double end_low = kTransmittanceMin * (1 - 2 * kRoundoff),
                 end_high = kTransmittanceMin * (1 + 2 * kRoundoff);
    if (after.high() < end_low) {
      // Splats that may be skipped end nothing surely.
      finished_ = surely;
      may_be_finished_ = true;
      return;
    }
    if (!(after.low() > end_high)) may_be_finished_ = true;
    const bool both = !surely || may_be_finished_;
    for (int channel = 0; channel < 3; ++channel) {
      const Tracked sum = colour_[channel] + s.rgb[channel] * weight;
      colour_[channel] = both ? hull(colour_[channel], sum) : sum;
    }
    t_ = both ? hull(t_, after) : after;
  }

 private:
  // As the renderers take it: from the corner of the sub-tile, then within it.
  static Tracked offset(Tracked centre, int pixel) {
    const int corner = pixel / kSubtilePx * kSubtilePx;
    return centre - Tracked(static_cast<float>(corner)) -
           Tracked(static_cast<float>(pixel - corner));
  }
  Tracked t_{1.0F}, colour_[3] = {Tracked(0.0F), Tracked(0.0F), Tracked(0.0F)};
  bool finished_ = false, may_be_finished_ = false;
};

Tracked tracked_opacity(const GaussianCloud& cloud, std::size_t i) {
  return rounded(1 / (1 + std::exp(-static_cast<double>(cloud.opacity_logits[i]))));
}

class Bounding {
 public:
  Bounding(const Camera& camera, const GaussianCloud& cloud)
      : camera_(camera), cloud_(cloud), view_(tracked_view(camera)) {}

  PixelBounds run(const RenderResult& in_float) {
    project_all();
    const OracleImage in_double = oracle_blend(camera_, oracle_);
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        const Blending pixel = blend_pixel(x, y);
        const auto at = static_cast<std::size_t>(y) * camera_.width + x;
        judge(x, y, "T", pixel.transmittance(), in_float.transmittance[at],
              in_double.transmittance[at]);
        double widest = 0;
        for (int channel = 0; channel < 3; ++channel) {
          judge(x, y, "colour", pixel.colour(channel), in_float.image.pixels[at][channel],
                in_double.pixels[at][channel]);
          widest = std::max(widest, pixel.colour(channel).error);
        }
        ++out_.pixels;
        out_.narrow += widest <= largest_colour_ / 512 ? 1 : 0;
      }
    }
    return out_;
  }

 private:
  // In float's order, with float's rectangles, of float, intervals and oracle alike.
  void project_all() {
    const View<float> view = make_view<float>(camera_);
    const ActivatedCloud activated = activate(cloud_);
    const std::vector<OracleSplat> all = oracle_project(camera_, cloud_);
    std::vector<std::pair<TrackedSplat, OracleSplat>> both;
    for (const OracleSplat& oracle : all) {
      const std::size_t i = oracle.index;
      SplatOf<float> splat{};
      Projected<float> p{};
      if (!make_geometry(view, activated.gaussians[i], splat, p)) continue;
      TrackedSplat s = tracked_splat(i);
      s.tiles = tile_rect(p.x, p.y, p.radius, camera_.width, camera_.height);
      s.depth = p.depth;
      both.emplace_back(s, oracle);
      OracleSplat& o = both.back().second;
      o.x0 = s.tiles.x0, o.y0 = s.tiles.y0, o.x1 = s.tiles.x1, o.y1 = s.tiles.y1;
    }
    std::sort(both.begin(), both.end(), [](const auto& a, const auto& b) {
      return std::pair{a.first.depth, a.first.index} < std::pair{b.first.depth, b.first.index};
    });
    for (const auto& [splat, oracle] : both) {
      splats_.push_back(splat);
      oracle_.push_back(oracle);
      for (const Tracked& channel : splat.rgb) {
        largest_colour_ = std::max(largest_colour_, channel.value);
      }
    }
  }

  TrackedSplat tracked_splat(std::size_t i) const {
    TrackedSplat s{};
    s.index = static_cast<std::uint32_t>(i);
    const Gaussian<Tracked> g = tracked_gaussian(cloud_, i);
    const auto p = project(view_, g, to_camera(view_, g.mean));
    s.x = p.x;
    s.y = p.y;
    s.conic = log2_conic(p.conic_a, p.conic_b, p.conic_c);
    s.opacity = tracked_opacity(cloud_, i);
    const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud_.sh_degree));
    glm::vec<3, Tracked> sh[16];
    for (std::size_t k = 0; k < coeffs; ++k) {
      for (int channel = 0; channel < 3; ++channel) {
        sh[k][channel] = Tracked(cloud_.sh_coeffs[i * coeffs + k][channel]);
      }
    }
    const auto rgb = sh_colour(cloud_.sh_degree, sh, from_eye(view_, g.mean));
    for (int channel = 0; channel < 3; ++channel) s.rgb[channel] = rgb[channel];
    return s;
  }

  Blending blend_pixel(int x, int y) const {
    Blending pixel;
    for (const TrackedSplat& s : splats_) {
      const int tile_x = x / kTilePx, tile_y = y / kTilePx;
      if (tile_x < s.tiles.x0 || tile_x >= s.tiles.x1) continue;
      if (tile_y < s.tiles.y0 || tile_y >= s.tiles.y1) continue;
      pixel.blend(s, x, y);
      if (pixel.finished()) break;
    }
    return pixel;
  }

  void judge(int x, int y, const char* what, Tracked bound, double in_float, double in_double) {
    // The oracle rounds too, in double.
    const double room = bound.error * (1 + 1e-9) + 1e-11 * (std::abs(bound.value) + 1e-3);
    for (const auto& [name, value] : {std::pair{"float", in_float}, {"double", in_double}}) {
      if (std::abs(value - bound.value) <= room || bound.error == kInfinity) continue;
      if (out_.outside++ > 0) continue;
      out_.first_outside = fmt::format("pixel ({}, {}), {} in {}: {}, expected {} within {}", x, y,
                                       what, name, value, bound.value, room);
    }
  }

  const Camera& camera_;
  const GaussianCloud& cloud_;
  const View<Tracked> view_;
  std::vector<TrackedSplat> splats_;
  std::vector<OracleSplat> oracle_;
  double largest_colour_ = 1;
  PixelBounds out_;
};

}  // namespace

PixelBounds bound_pixels(const Camera& camera, const GaussianCloud& cloud,
                         const RenderResult& in_float) {
  return Bounding(camera, cloud).run(in_float);
}

}  // namespace sgs::test
