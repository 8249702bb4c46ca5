// The picture of a few Gaussians and its derivatives, pixel by pixel, in any scalar: made of the
// templates of algorithm/splat and algorithm/tune and of loops that are too plain to be wrong.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <vector>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/tune/gaussian_gradient.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs::test {

// Gaussians with all their parameters.
template <class T>
struct SceneOf {
  int sh_degree = 0;
  std::vector<RawGaussian<T>> raw;
  std::vector<glm::vec<3, T>> sh;  // [N, (degree+1)^2]

  std::size_t coeffs() const { return static_cast<std::size_t>(sh_coeff_count(sh_degree)); }
};

template <class To, class From>
SceneOf<To> converted(const SceneOf<From>& scene) {
  SceneOf<To> out;
  out.sh_degree = scene.sh_degree;
  for (const auto& r : scene.raw) {
    RawGaussian<To> g{};
    for (int k = 0; k < 3; ++k) g.mean[k] = To(r.mean[k]), g.log_scale[k] = To(r.log_scale[k]);
    for (std::size_t k = 0; k < 4; ++k) g.quat[k] = To(r.quat[k]);
    g.opacity_logit = To(r.opacity_logit);
    out.raw.push_back(g);
  }
  for (const auto& c : scene.sh) out.sh.push_back({To(c.x), To(c.y), To(c.z)});
  return out;
}

// Calls visit(parameter of each scene...) for the parameters of Gaussian i, in one order.
template <class Visit, class... Scenes>
void for_parameters(std::size_t i, const Visit& visit, Scenes&... scenes) {
  for (int k = 0; k < 3; ++k) visit(scenes.raw[i].mean[k]...);
  for (int k = 0; k < 3; ++k) visit(scenes.raw[i].log_scale[k]...);
  for (std::size_t k = 0; k < 4; ++k) visit(scenes.raw[i].quat[k]...);
  visit(scenes.raw[i].opacity_logit...);
  const std::size_t coeffs = std::max({scenes.coeffs()...});
  for (std::size_t c = i * coeffs; c < (i + 1) * coeffs; ++c) {
    for (int k = 0; k < 3; ++k) visit(scenes.sh[c][k]...);
  }
}

// Sum over pixels of colour . C + transmittance T_end.
struct LinearLoss {
  std::vector<glm::dvec3> colour;     // [height, width]
  std::vector<double> transmittance;  // [height, width]
  glm::dvec3 background{0.0};
};

// Which splats are blended into a sub-tile, in which order: positions in the splats given.
using Sequence =
    std::function<std::vector<std::uint32_t>(const std::vector<float>& depths, int x, int y)>;

inline std::vector<std::uint32_t> by_depth(const std::vector<float>& depths, int, int) {
  std::vector<std::uint32_t> order(depths.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return depths[a] < depths[b]; });
  return order;
}

// As a streaming order is: what lies in front is blended first only within blocks of three splats,
// and the blocks' order is another in each group of 8 x 8 px.
inline std::vector<std::uint32_t> by_visits(const std::vector<float>& depths, int x, int y) {
  std::vector<std::uint32_t> order = by_depth(depths, x, y);
  const auto visit = [&](std::uint32_t i) {
    return (i / 3 * 7 + static_cast<std::uint32_t>(x / 2 + 3 * (y / 2))) % 5;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return visit(a) < visit(b); });
  return order;
}

template <class T>
struct ProjectedScene {
  std::vector<Gaussian<T>> gaussians;
  std::vector<SplatOf<T>> splats;
  std::vector<float> depths;
};

template <class T>
ProjectedScene<T> project_scene(const View<T>& view, const SceneOf<T>& scene) {
  ProjectedScene<T> out;
  for (std::size_t i = 0; i < scene.raw.size(); ++i) {
    out.gaussians.push_back(activate(scene.raw[i]));
    SplatOf<T> splat{};
    const auto& g = out.gaussians.back();
    if (make_geometry(view, g, splat)) {
      add_colour(view, scene.sh_degree, g.mean, &scene.sh[i * scene.coeffs()], splat);
    } else {
      splat.footprint = {};
    }
    out.splats.push_back(splat);
    out.depths.push_back(static_cast<float>(static_cast<double>(splat.depth)));
  }
  return out;
}

// One splat blended into a pixel.
template <class T>
struct PixelShare {
  std::uint32_t splat;
  T dx, dy, alpha, before;
};
template <class T>
struct BlendedPixel {
  glm::vec<3, T> colour;
  T transmittance;
  std::vector<PixelShare<T>> shares;
};

template <class T>
BlendedPixel<T> blend_pixel(const ProjectedScene<T>& scene, const Sequence& sequence,
                            const glm::dvec3& background, int x, int y) {
  BlendedPixel<T> out{glm::vec<3, T>{T(0.0)}, T(1.0), {}};
  const int column = x / kSubtilePx, row = y / kSubtilePx;
  for (const std::uint32_t i : sequence(scene.depths, column, row)) {
    const SplatOf<T>& s = scene.splats[i];
    const SubtileRect& f = s.footprint;
    if (column < f.x0 || column >= f.x1 || row < f.y0 || row >= f.y1) continue;
    const T dx = T(s.x - T(static_cast<double>(x))), dy = T(s.y - T(static_cast<double>(y)));
    const T alpha = alpha_at(s.conic_a, s.conic_b, s.conic_c, s.opacity, dx, dy);
    if (!(alpha > T(0.0))) continue;
    const LightShare<T> light = take_light(alpha, out.transmittance);
    if (light.after < constant<T>(kTransmittanceMin)) break;
    out.shares.push_back({i, dx, dy, alpha, out.transmittance});
    for (int k = 0; k < 3; ++k) out.colour[k] = T(out.colour[k] + light.weight * s.rgb[k]);
    out.transmittance = light.after;
  }
  for (int k = 0; k < 3; ++k) {
    out.colour[k] = T(out.colour[k] + out.transmittance * T(background[k]));
  }
  return out;
}

template <class T>
T loss_of(const View<T>& view, const SceneOf<T>& scene, const LinearLoss& loss,
          const Sequence& sequence) {
  const ProjectedScene<T> projected = project_scene(view, scene);
  T out(0.0);
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto at = static_cast<std::size_t>(y * view.width + x);
      const auto pixel = blend_pixel(projected, sequence, loss.background, x, y);
      for (int k = 0; k < 3; ++k) {
        out = T(out + T(loss.colour[at][k]) * pixel.colour[k]);
      }
      out = T(out + T(loss.transmittance[at]) * pixel.transmittance);
    }
  }
  return out;
}

// dL/d of every parameter by the templates of algorithm/tune.
template <GradientRule kRule = GradientRule::kDerivative, class T>
SceneOf<T> gradient_of(const View<T>& view, const SceneOf<T>& scene, const LinearLoss& loss,
                       const Sequence& sequence) {
  const ProjectedScene<T> projected = project_scene(view, scene);
  std::vector<FalloffMoments<T>> sums(scene.raw.size());
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto at = static_cast<std::size_t>(y * view.width + x);
      const auto pixel = blend_pixel(projected, sequence, loss.background, x, y);
      const auto by = glm::vec<3, T>(loss.colour[at]);
      const double by_end = glm::dot(loss.colour[at], loss.background) + loss.transmittance[at];
      T behind = T(T(by_end) * pixel.transmittance);
      for (std::size_t k = pixel.shares.size(); k-- > 0;) {
        const PixelShare<T>& share = pixel.shares[k];
        const SplatOf<T>& s = projected.splats[share.splat];
        FalloffMoments<T>& sum = sums[share.splat];
        const auto arm = conic_arm(s.conic_a, s.conic_b, s.conic_c, share.dx, share.dy);
        const T slope = slope_of_alpha<kRule>(
            share.alpha, [&] { return T(s.opacity * falloff_at(arm, share.dx, share.dy)); });
        const T toward = T(by.x * s.rgb.x + by.y * s.rgb.y + by.z * s.rgb.z);
        const auto gradient = share_gradient(share.alpha, share.before, toward, behind, slope);
        behind = gradient.behind;
        const T f = gradient.falloff;
        sum.one += f;
        sum.x += f * arm.x;
        sum.y += f * arm.y;
        sum.xx += f * arm.x * arm.x;
        sum.xy += f * arm.x * arm.y;
        sum.yy += f * arm.y * arm.y;
        sum.red += gradient.weight * by.x;
        sum.green += gradient.weight * by.y;
        sum.blue += gradient.weight * by.z;
      }
    }
  }
  SceneOf<T> out;
  out.sh_degree = scene.sh_degree;
  out.raw.resize(scene.raw.size());
  out.sh.resize(scene.sh.size());
  for (std::size_t i = 0; i < scene.raw.size(); ++i) {
    const SplatOf<T>& s = projected.splats[i];
    if (s.footprint.empty()) continue;
    const auto first = i * scene.coeffs();
    const auto by =
        gaussian_gradient(view, projected.gaussians[i], scene.sh_degree, &scene.sh[first], s.rgb,
                          splat_gradient(sums[i], s.opacity), kRule, &out.sh[first]);
    out.raw[i] = activation_gradient(scene.raw[i], projected.gaussians[i], by);
  }
  return out;
}

}  // namespace sgs::test
