// Scenes that are stiff, and their tuning.
#include "testbench/stability/stiff_tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/activate.h"
#include "algorithm/train/photographs.h"
#include "algorithm/train/scene_tuner.h"
#include "testbench/builtin/builtin_scene.h"

namespace sgs {
namespace {

constexpr int kWidthPx = 64;
constexpr std::size_t kViews = 3;

struct Usual {
  GaussianCloud cloud;
  std::vector<Camera> cameras;
  Photographs pictures;

  Usual() : pictures(0, {}) {
    auto scene = make_builtin_scene("builtin:object?n=300");
    cloud = std::move(scene.cloud);
    cameras = std::move(scene.cameras);
    cameras.resize(kViews);
    for (Camera& camera : cameras) {
      const double smaller = static_cast<double>(kWidthPx) / camera.width;
      camera.height = static_cast<int>(camera.height * smaller);
      camera.width = kWidthPx;
      camera.focal_x *= smaller;
      camera.focal_y *= smaller;
    }
    pictures = own_pictures(activate(cloud), cameras);
    pictures.load(1);
  }
};

const Usual& usual() {
  static const Usual scene;
  return scene;
}

// Two axes are shorter than the first by `log_ratio`.
std::function<void(GaussianCloud&)> needles(float log_ratio) {
  return [=](GaussianCloud& cloud) {
    for (glm::vec3& scale : cloud.log_scales) {
      scale.y = scale.x - log_ratio;
      scale.z = scale.x - log_ratio;
    }
  };
}
std::function<void(GaussianCloud&)> scales(float log_scale) {
  return [=](GaussianCloud& cloud) {
    for (std::size_t i = 0; i < cloud.size(); i += 10) cloud.log_scales[i] = glm::vec3(log_scale);
  };
}
std::function<void(GaussianCloud&)> opacities(float logit) {
  return [=](GaussianCloud& cloud) {
    for (std::size_t i = 0; i < cloud.size(); i += 2) cloud.opacity_logits[i] = logit;
  };
}
std::function<void(GaussianCloud&)> colours(float coefficient) {
  return [=](GaussianCloud& cloud) {
    for (std::size_t i = 0; i < cloud.sh_coeffs.size(); i += 7) {
      cloud.sh_coeffs[i] = glm::vec3(coefficient);
    }
  };
}
std::function<void(GaussianCloud&)> quaternions(float length) {
  return [=](GaussianCloud& cloud) {
    for (auto& quat : cloud.quats) {
      for (float& part : quat) part *= length;
    }
  };
}

bool all_finite(const Image& image) {
  for (const glm::vec3& pixel : image.pixels) {
    if (!std::isfinite(pixel.x + pixel.y + pixel.z)) return false;
  }
  return true;
}

bool within_limits(const GaussianCloud& cloud) {
  const auto within = [](const glm::vec3& v, double most) {
    return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
  };
  bool good = true;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& q = cloud.quats[i];
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    const glm::vec3& s = cloud.log_scales[i];
    good = good && within(cloud.means[i], kMaxCoordinate) && std::isfinite(s.x + s.y + s.z) &&
           std::max({s.x, s.y, s.z}) <= kMaxLogScale && std::isfinite(length) && length > 0 &&
           std::isfinite(cloud.opacity_logits[i]);
  }
  for (const glm::vec3& coeff : cloud.sh_coeffs) good = good && within(coeff, kMaxCoefficient);
  return good;
}

bool is_good(const SceneTuner& tuner) {
  const SceneTuner::State back = SceneTuner::restored(tuner.saved());
  if (back.cloud.log_scales != tuner.cloud().log_scales || !within_limits(back.cloud)) return false;
  const auto view = make_view<float>(usual().cameras.front());
  return all_finite(render_reference(view, activate(back.cloud), glm::vec3(0)).image);
}

}  // namespace

std::vector<StiffCase> stiff_cases() {
  const auto none = [](GaussianCloud&) {};
  const auto all = [](LearningSchedule& rates, double factor) {
    for (double* rate :
         {&rates.log_scale, &rates.quat, &rates.opacity_logit, &rates.sh_dc, &rates.sh_rest}) {
      *rate *= factor;
    }
  };
  const auto of = [](double LearningSchedule::*rate) {
    return [=](LearningSchedule& rates, double factor) { rates.*rate *= factor; };
  };
  const float thousand = std::log(1e3F), million = std::log(1e6F), most = kMaxLogScale;
  return {{"as it is", "all", none, all},
          {"as it is", "scales", none, of(&LearningSchedule::log_scale)},
          {"as it is", "rotations", none, of(&LearningSchedule::quat)},
          {"as it is", "opacities", none, of(&LearningSchedule::opacity_logit)},
          {"as it is", "colours", none, of(&LearningSchedule::sh_dc)},
          {"needles, condition 10^6", "all", needles(thousand), all},
          {"needles, condition 10^12", "all", needles(million), all},
          {"one in ten of scale 10^7, the limit", "all", scales(0.999F * most), all},
          {"one in ten of scale e^-40", "all", scales(-40), all},
          {"half opaque, logit 30", "all", opacities(30), all},
          {"half hidden, logit -30", "all", opacities(-30), all},
          {"one coefficient in seven 10^17", "all", colours(1e17F), all},
          {"quaternions of length 10^-15", "all", quaternions(1e-15F), all},
          {"quaternions of length 10^15", "all", quaternions(1e15F), all}};
}

StiffRun tuned(const StiffCase& of, double factor, int steps) {
  GaussianCloud cloud = usual().cloud;
  of.make_stiff(cloud);
  TuningConfig config;
  config.steps = steps;
  of.lengthen(config.rates, factor);
  SceneTuner tuner(config, usual().pictures, reference_order(), {}, std::move(cloud));
  StiffRun run{factor, 0, {}, 0, 0, false};
  try {
    while (!tuner.done()) {
      run.last_loss = tuner.step().loss;
      if (run.steps == 0) run.first_loss = run.last_loss;
      ++run.steps;
    }
  } catch (const NotFinite& stopped) {
    run.stopped = stopped.what();
  }
  run.good = is_good(tuner);
  return run;
}

}  // namespace sgs
