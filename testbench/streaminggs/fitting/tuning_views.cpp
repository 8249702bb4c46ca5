#include "testbench/streaminggs/fitting/tuning_views.h"

#include <fmt/format.h>

#include <utility>

#include "algorithm/train/photographs.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {

TuningViews views_of_dataset(Dataset given) {
  auto dataset = std::make_unique<const Dataset>(std::move(given));
  std::vector<Camera> cameras;
  for (const int view : views_of(*dataset, Split::kTrain)) {
    cameras.push_back(dataset->views[static_cast<std::size_t>(view)].camera);
  }
  Photographs tune(*dataset, Split::kTrain), test(*dataset, Split::kTest);
  tune.load(1);
  test.load(1);
  std::string says = fmt::format("{} photographs of {}, {} others to test with",
                                 grouped(tune.size()), dataset->folder, grouped(test.size()));
  return {std::move(dataset), std::move(cameras), std::move(tune), std::move(test),
          std::move(says)};
}

TuningViews views_of_scene(const std::string& pictures, const ActivatedCloud& cloud,
                           const std::vector<Camera>& cameras, std::uint32_t between,
                           std::uint64_t seed) {
  constexpr std::size_t kTestEvery = 8;
  std::vector<Camera> tune, test;
  if (between > 0) {
    test = cameras;
    tune = cameras_between(cameras, between, seed);
  } else {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      (i % kTestEvery == 0 ? test : tune).push_back(cameras[i]);
    }
    if (tune.empty()) tune = test;
  }
  const bool alone = between == 0 && cameras.size() == 1;
  TuningViews out{nullptr, tune, own_pictures(cloud, tune), own_pictures(cloud, test), ""};
  out.tune.load(1);
  out.test.load(1);
  out.says = fmt::format("no photographs: {}, {} views{}, {} to test with", pictures,
                         grouped(tune.size()), between > 0 ? " between the cameras" : "",
                         alone ? "the same one" : grouped(test.size()));
  return out;
}

std::vector<PixelSize> frame_sizes(const TuningViews& views) {
  std::vector<PixelSize> sizes;
  for (const Camera& camera : views.cameras) sizes.push_back({camera.width, camera.height});
  return sizes;
}

}  // namespace sgs
