// Small scenes of every kind that makes derivatives hard, before a camera at the origin that looks
// along +z with 20 x 12 px and a focal length of 15 px.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/tune/pixel_loop.h"

namespace sgs::test {

inline Camera small_camera() { return forward_camera(20, 12, 15); }

class HardGaussians {
 public:
  explicit HardGaussians(unsigned seed, int degree) : random_(seed) { scene_.sh_degree = degree; }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double normal() { return std::normal_distribution<double>()(random_); }

  // Anywhere before the camera, some px wide.
  RawGaussian<double>& add() {
    RawGaussian<double> g{};
    const double depth = uniform(1, 6);
    g.mean = {depth * uniform(-0.6, 0.6), depth * uniform(-0.4, 0.4), depth};
    for (int k = 0; k < 3; ++k) g.log_scale[k] = std::log(depth * uniform(0.02, 0.4));
    for (double& component : g.quat) component = normal();
    g.opacity_logit = uniform(-3, 2);
    scene_.raw.push_back(g);
    for (std::size_t c = 0; c < scene_.coeffs(); ++c) {
      scene_.sh.push_back({0.4 * normal(), 0.4 * normal(), 0.4 * normal()});
    }
    return scene_.raw.back();
  }
  SceneOf<double> scene() const { return scene_; }

  LinearLoss loss(const Camera& camera) {
    LinearLoss out;
    for (int i = 0; i < camera.width * camera.height; ++i) {
      out.colour.push_back({normal(), normal(), normal()});
      out.transmittance.push_back(normal());
    }
    out.background = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
    return out;
  }

 private:
  std::mt19937 random_;
  SceneOf<double> scene_;
};

struct HardScene {
  std::string name;
  SceneOf<double> scene;
  LinearLoss loss;
};

inline std::vector<HardScene> hard_scenes() {
  using Raw = RawGaussian<double>;
  struct Kind {
    std::string name;
    void (*change)(Raw& g, HardGaussians& random);
  };
  const Kind kinds[] = {
      {"as they come", [](Raw&, HardGaussians&) {}},
      {"capped", [](Raw& g, HardGaussians& r) { g.opacity_logit = r.uniform(5, 9); }},
      {"clamped",
       [](Raw& g, HardGaussians& r) {
         g.mean.x = g.mean.z * (g.mean.x > 0 ? 1 : -1) * r.uniform(0.9, 1.3);
         if (r.uniform(0, 1) < 0.5) g.mean.y = g.mean.z * r.uniform(0.55, 0.8);
         for (int k = 0; k < 3; ++k) g.log_scale[k] += 1.5;
       }},
      {"on the near plane",
       [](Raw& g, HardGaussians& r) { g.mean *= r.uniform(0.2000001, 0.2001) / g.mean.z; }},
      {"needles of ratio 10^6",
       [](Raw& g, HardGaussians& r) {
         g.log_scale.x += r.uniform(0, 2);
         g.log_scale.y = g.log_scale.z = g.log_scale.x - std::log(1e6);
       }},
      {"discs without thickness", [](Raw& g, HardGaussians&) { g.log_scale.y = -80; }},
      {"points",
       [](Raw& g, HardGaussians&) { g.log_scale.x = g.log_scale.y = g.log_scale.z = -60; }},
      {"long and short quaternions",
       [](Raw& g, HardGaussians& r) {
         const double length = std::exp(r.uniform(-12, 12));
         for (double& component : g.quat) component *= length;
       }},
      {"hardly visible",
       [](Raw& g, HardGaussians& r) {
         const double opacity = r.uniform(1.001, 1.5) / 255;
         g.opacity_logit = std::log(opacity / (1 - opacity));
       }},
      {"opaque",
       [](Raw& g, HardGaussians& r) {
         g.opacity_logit = r.uniform(30, 36);
         for (int k = 0; k < 3; ++k) g.log_scale[k] -= 1;
       }},
  };
  std::vector<HardScene> scenes;
  unsigned seed = 1;
  for (const Kind& kind : kinds) {
    for (const int degree : {0, 1, 2, 3}) {
      HardGaussians random(seed++, degree);
      for (int i = 0; i < 9; ++i) {
        Raw& g = random.add();
        if (i % 3 != 2) kind.change(g, random);
      }
      scenes.push_back({kind.name + ", degree " + std::to_string(degree), random.scene(),
                        random.loss(small_camera())});
    }
  }
  return scenes;
}

}  // namespace sgs::test
