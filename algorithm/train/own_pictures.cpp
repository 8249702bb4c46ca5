#include "algorithm/train/own_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "algorithm/input_error.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/camera_between.h"
#include "algorithm/scene/cameras.h"
#include "algorithm/train/counter_random.h"

namespace sgs {

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
