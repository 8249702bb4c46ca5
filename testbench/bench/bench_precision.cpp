// The cost of half precision and fixed point to the picture, by stage of blending: each view
// blended pixel by pixel in several arithmetics, PSNR beside double. Twice: in all sub-tiles of
// each splat's footprint, and in those that its ellipse reaches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/fixed_pixel.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/make_splat.h"
#include "testbench/bench/bench_scene.h"
#include "testbench/command_line/guard.h"

namespace sgs {
namespace {

constexpr int kWidth = 640, kHeight = 360;

enum class Pixels { kFloat, kHalf, kFixed };
struct Arithmetic {
  const char* name;
  bool exponent_in_half;
  Pixels pixels;
};
constexpr Arithmetic kArithmetics[] = {
    {"float", false, Pixels::kFloat},
    {"pixels in half", false, Pixels::kHalf},
    {"pixels in fixed point", false, Pixels::kFixed},
    {"exponent in half", true, Pixels::kFloat},
    {"both in half", true, Pixels::kHalf},
    {"exponent in half, pixels in fixed point", true, Pixels::kFixed},
};
constexpr std::size_t kCount = std::size(kArithmetics);

template <class T>
struct Pixel {
  T light = 1, rgb[3] = {0, 0, 0};
  bool finished = false;

  void blend(T alpha, const glm::vec3& colour) {
    if (finished || !(alpha > 0)) return;
    const LightShare<T> share = take_light(alpha, light);
    finished = share.after < constant<T>(kTransmittanceMin);
    if (finished) return;
    for (int c = 0; c < 3; ++c) rgb[c] += colour[c] * share.weight;
    light = share.after;
  }
};
void blend_in_half(Pixel<float>& pixel, HalfScalar alpha, const glm::vec3& colour) {
  if (pixel.finished || !(alpha.value() > 0)) return;
  const auto share = take_light(alpha, HalfScalar::exactly(pixel.light));
  pixel.finished = share.after < constant<HalfScalar>(kTransmittanceMin);
  if (pixel.finished) return;
  for (int c = 0; c < 3; ++c) {
    const HalfScalar before = HalfScalar::exactly(pixel.rgb[c]);
    pixel.rgb[c] = (before + HalfScalar(colour[c]) * share.weight).value();
  }
  pixel.light = share.after.value();
}

void blend_in_fixed_point(Pixel<float>& pixel, float alpha, const glm::vec3& colour) {
  if (pixel.finished || !(alpha > 0)) return;
  const FixedShare share = take_fixed_light(in_fixed_units(alpha, kFixedLight),
                                            in_fixed_units(pixel.light, kFixedLight));
  pixel.finished = share.after < kFixedTransmittanceMin;
  if (pixel.finished) return;
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t before = in_fixed_units(pixel.rgb[c], kFixedColour);
    pixel.rgb[c] = of_fixed_units(add_fixed_colour(before, fixed_colour(colour[c]), share.weight),
                                  kFixedColour);
  }
  pixel.light = of_fixed_units(share.after, kFixedLight);
}

// A splat in float, and its place and conic in double.
struct Candidate {
  Splat splat;
  SplatOf<double> in_double;
};

template <class T>
Gaussian<T> widened(const Gaussian<float>& g) {
  return {glm::vec<3, T>(g.mean),
          glm::vec<3, T>(g.scale),
          {T(g.quat[0]), T(g.quat[1]), T(g.quat[2]), T(g.quat[3])},
          T(g.opacity)};
}

// Front to back.
std::vector<Candidate> candidates(const Camera& camera, const ActivatedCloud& cloud) {
  const auto view = make_view<float>(camera);
  const auto view_in_double = make_view<double>(camera);
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Candidate c{};
    Projected<float> p;
    if (!make_geometry(view, cloud.gaussians[i], c.splat, p)) continue;
    add_colour(view, cloud.sh_degree, cloud.gaussians[i].mean, cloud.sh(i), c.splat);
    c.splat.index = static_cast<std::uint32_t>(i);
    const Gaussian<double> g = widened<double>(cloud.gaussians[i]);
    const auto exact = project(view_in_double, g, to_camera(view_in_double, g.mean));
    c.in_double.x = exact.x;
    c.in_double.y = exact.y;
    c.in_double.conic_a = exact.conic_a;
    c.in_double.conic_b = exact.conic_b;
    c.in_double.conic_c = exact.conic_c;
    out.push_back(c);
  }
  std::sort(out.begin(), out.end(),
            [](const Candidate& a, const Candidate& b) { return in_front(a.splat, b.splat); });
  return out;
}

struct Pictures {
  std::vector<Pixel<double>> in_double;
  std::vector<Pixel<float>> of[kCount];

  Pictures() : in_double(std::size_t{kWidth} * kHeight) {
    for (auto& picture : of) picture.resize(in_double.size());
  }

  void blend(const Candidate& c, int subtile_x, int subtile_y) {
    const Splat& s = c.splat;
    const float left = s.x - static_cast<float>(subtile_x * kSubtilePx);
    const float top = s.y - static_cast<float>(subtile_y * kSubtilePx);
    const auto in = blend_input(s, left, top);
    const auto in_half = blend_input_in_half<HalfScalar>(square_splat(s), left, top);
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      const int column = lane % kSubtilePx, row = lane / kSubtilePx;
      const int x = subtile_x * kSubtilePx + column, y = subtile_y * kSubtilePx + row;
      if (x >= kWidth || y >= kHeight) continue;
      const std::size_t at = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
      in_double[at].blend(alpha_at(c.in_double.conic_a, c.in_double.conic_b, c.in_double.conic_c,
                                   double{s.opacity}, c.in_double.x - x, c.in_double.y - y),
                          s.rgb);
      const float dx = in.left - static_cast<float>(column);
      const float dy = in.top - static_cast<float>(row);
      const auto alpha = [](auto exponent, auto opacity) {
        return alpha_of(exponent, exp2_of(exponent), opacity);
      };
      const HalfScalar of_x(static_cast<float>(column) * in_half.pixel_x);
      const HalfScalar of_y(static_cast<float>(row) * in_half.pixel_y);
      const HalfScalar half = alpha(
          log2_falloff(in_half.conic, in_half.left - of_x, in_half.top - of_y), in_half.opacity);
      const float single = alpha(log2_falloff(in.conic, dx, dy), in.opacity);
      for (std::size_t k = 0; k < kCount; ++k) {
        const Arithmetic& how = kArithmetics[k];
        Pixel<float>& pixel = of[k][at];
        const float in_float = how.exponent_in_half ? half.value() : single;
        switch (how.pixels) {
          case Pixels::kFloat:
            pixel.blend(in_float, s.rgb);
            break;
          case Pixels::kHalf:
            blend_in_half(pixel, how.exponent_in_half ? half : HalfScalar(single), s.rgb);
            break;
          case Pixels::kFixed:
            blend_in_fixed_point(pixel, in_float, s.rgb);
            break;
        }
      }
    }
  }

  double psnr_db(std::size_t k) const {
    double squares = 0;
    for (std::size_t at = 0; at < in_double.size(); ++at) {
      for (int c = 0; c < 3; ++c) {
        const double d = std::clamp(double{of[k][at].rgb[c]}, 0.0, 1.0) -
                         std::clamp(in_double[at].rgb[c], 0.0, 1.0);
        squares += d * d;
      }
    }
    return -10 * std::log10(squares / (3.0 * static_cast<double>(in_double.size())));
  }
};

void measure(const std::string& spec) {
  const Scene scene = load_bench_scene(spec);
  const ActivatedCloud cloud = activate(scene.cloud);
  for (const Camera& full : scene.cameras) {
    const Camera camera = scaled_to(full, kWidth, kHeight);
    Pictures everywhere, reached;
    for (const Candidate& c : candidates(camera, cloud)) {
      const auto& s = c.splat;
      for (int y = s.footprint.y0; y < s.footprint.y1; ++y) {
        for (int x = s.footprint.x0; x < s.footprint.x1; ++x) {
          everywhere.blend(c, x, y);
          const PixelRect pixels{x * kSubtilePx, y * kSubtilePx, (x + 1) * kSubtilePx,
                                 (y + 1) * kSubtilePx};
          if (reaches(s.x, s.y, s.conic_a, s.conic_b, s.conic_c, visible_cutoff(s.opacity),
                      pixels)) {
            reached.blend(c, x, y);
          }
        }
      }
    }
    fmt::print("| {} {} |", scene.name, camera.id);
    for (std::size_t k = 0; k < kCount; ++k) {
      fmt::print(" {:.1f}, {:.1f} |", everywhere.psnr_db(k), reached.psnr_db(k));
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sgs

int main(int argc, char** argv) {
  return sgs::run_guarded("bench_precision", [&] {
    if (argc < 2) throw sgs::InputError("got no scene, expected bench_precision SCENE...");
    fmt::print(
        "PSNR in dB of {}x{} px beside double: sub-tiles of the footprint, of them those that the "
        "ellipse reaches\n| view |",
        sgs::kWidth, sgs::kHeight);
    for (const auto& how : sgs::kArithmetics) fmt::print(" {} |", how.name);
    fmt::print("\n| --- |");
    for (std::size_t k = 0; k < sgs::kCount; ++k) fmt::print(" --- |");
    fmt::print("\n");
    for (int i = 1; i < argc; ++i) sgs::measure(argv[i]);
    return sgs::kDone;
  });
}
