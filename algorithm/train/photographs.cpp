
#include "algorithm/train/photographs.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "algorithm/dataset/dataset.h"
#include "algorithm/files/input_error.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/train/counter_random.h"

namespace sgs {
namespace {

constexpr float kWhole = 65535;

std::uint16_t rounded(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * kWhole));
}

}  // namespace

Photographs::Photographs(const Dataset& dataset, Split split)
    : Photographs(views_of(dataset, split).size(),
                  [&dataset, views = views_of(dataset, split)](std::size_t at, double downscale) {
                    const auto number = static_cast<std::size_t>(views[at]);
                    const DatasetView& view = dataset.views[number];
                    return Photograph{downscaled_camera(view, downscale),
                                      load_view(view, downscale), load_mask(view, downscale)};
                  }) {}

void Photographs::load(double downscale) {
  tbb::parallel_for(std::size_t{0}, stored_.size(), [&](std::size_t at) {
    Photograph photograph = source_(at, downscale);
    Stored& stored = stored_[at];
    stored.counts = std::move(photograph.counts);
    stored.camera = photograph.camera;
    stored.transparent = false;
    stored.pixels.resize(photograph.image.pixels.size());
    for (std::size_t i = 0; i < stored.pixels.size(); ++i) {
      const glm::vec4& pixel = photograph.image.pixels[i];
      stored.pixels[i] = {rounded(pixel.x), rounded(pixel.y), rounded(pixel.z), rounded(pixel.w)};
      stored.transparent = stored.transparent || stored.pixels[i][3] != 65535;
    }
  });
  transparent_ = std::any_of(stored_.begin(), stored_.end(),
                             [](const Stored& stored) { return stored.transparent; });
}

Image Photographs::before(std::size_t at, const glm::vec3& background) const {
  const Stored& stored = stored_[at];
  Image image(stored.camera.width, stored.camera.height);
  for (std::size_t i = 0; i < stored.pixels.size(); ++i) {
    const auto& p = stored.pixels[i];
    const float through = 1 - static_cast<float>(p[3]) / kWhole;
    for (int channel = 0; channel < 3; ++channel) {
      const float own = static_cast<float>(p[static_cast<std::size_t>(channel)]) / kWhole;
      image.pixels[i][channel] = own + through * background[channel];
    }
  }
  return image;
}

Photographs own_pictures(const ActivatedCloud& cloud, std::vector<Camera> cameras) {
  const std::size_t count = cameras.size();
  const auto scene = std::make_shared<const ActivatedCloud>(cloud);
  return Photographs(count, [scene, of = std::move(cameras)](std::size_t at, double downscale) {
    Photograph out;
    out.camera = of[at];
    if (downscale != 1) {
      out.camera = scaled_to(of[at], std::max(1, static_cast<int>(of[at].width / downscale)),
                             std::max(1, static_cast<int>(of[at].height / downscale)));
    }
    const Image picture = render_reference(make_view<float>(out.camera), *scene).image;
    out.image = RgbaImage(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      out.image.pixels[i] = glm::vec4(picture.pixels[i], 1);
    }
    return out;
  });
}

std::vector<Camera> cameras_between(const std::vector<Camera>& cameras, std::size_t count,
                                    std::uint64_t seed) {
  if (cameras.size() < 2) {
    throw InputError(fmt::format("got {} cameras, expected two or more to make others between them",
                                 cameras.size()));
  }
  std::vector<Camera> out;
  const RandomUse use = RandomUse::kCameras;
  for (std::size_t i = 0; i < count; ++i) {
    CounterRandom random{seed, use, 0, i};
    const std::size_t first = random.below(cameras.size());
    const std::size_t other = (first + 1 + random.below(cameras.size() - 1)) % cameras.size();
    const Camera &a = cameras[first], &b = cameras[other];
    const double t = random.uniform();
    Camera camera = camera_between(a, b, t);
    camera.id = static_cast<int>(i);
    camera.name = fmt::format("between_{}", i);
    out.push_back(camera);
  }
  return out;
}

}  // namespace sgs
