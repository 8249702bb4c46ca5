#include "algorithm/train/photographs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "algorithm/dataset/load_view.h"

namespace sgs {
namespace {

constexpr float kWhole = 65535;

std::uint16_t rounded(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * kWhole));
}

}  // namespace

Photographs::Photographs(const Dataset& dataset, Split split)
    : Photographs(views_of(dataset, split).size(), [&dataset, views = views_of(dataset, split)](
                                                       std::size_t at, double downscale) {
        const auto number = static_cast<std::size_t>(views[at]);
        const DatasetView& view = dataset.views[number];
        return Photograph{downscaled_camera(view, downscale), load_view(view, downscale)};
      }) {}

void Photographs::load(double downscale) {
  tbb::parallel_for(std::size_t{0}, stored_.size(), [&](std::size_t at) {
    const Photograph photograph = source_(at, downscale);
    Stored& stored = stored_[at];
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

}  // namespace sgs
