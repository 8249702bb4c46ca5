// Renders, compares, prints.
#include "tests/algorithm/render/paper_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/image/quality.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/nearest_tie_renderer.h"
#include "tests/algorithm/voxel/stored_clouds.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {

namespace {

class Range {
 public:
  void add(double db) {
    low_ = std::min(low_, db);
    high_ = std::max(high_, db);
  }
  void check_within(const PsnrRange& expected, double tolerance_db) const {
    CHECK(std::abs(low_ - expected.low_db) <= tolerance_db);
    CHECK(std::abs(high_ - expected.high_db) <= tolerance_db);
  }
  std::string text() const { return fmt::format("{:.2f} .. {:.2f} dB", low_, high_); }

 private:
  double low_ = 1e9, high_ = 0;
};

}  // namespace

void check_paper_quality(const PaperScene& scene) {
  constexpr int kGroupPx = 64;
  const auto cameras = read_view_cameras(shared_path("cameras/" + scene.name + ".json")).cameras;
  const auto [cloud, grid] =
      by_voxels(activate(read_ply(shared_scene(scene.name)).cloud), scene.voxel_size);
  Range first_met, nearest;
  StreamingStats sum;
  for (const Camera& camera : cameras) {
    const View<float> view = make_view<float>(camera);
    const Image reference = render_reference(view, cloud).image;
    PaperOrderConfig config;
    config.group = square_of(kGroupPx);
    const StreamingResult result = render_paper_order(view, cloud, grid, config);
    sum += result.stats;
    first_met.add(psnr_db(result.frame.image, reference));
    nearest.add(
        psnr_db(render_with_nearest_ties(view, cloud, grid, square_of(kGroupPx)), reference));
  }
  const auto mean_k = [&](std::uint64_t count) {
    return static_cast<double>(count) / (1000.0 * static_cast<double>(cameras.size()));
  };
  fmt::print(
      "{}: {}, nearest first {} (prototype {:.1f} .. {:.1f}); first halves {:.0f} k ({:.0f}), "
      "second {:.0f} k ({:.0f}); misordered {:.0f} %\n",
      scene.name, first_met.text(), nearest.text(), scene.prototype.low_db, scene.prototype.high_db,
      mean_k(sum.first_halves), scene.first_k, mean_k(sum.second_halves), scene.second_k,
      100.0 * static_cast<double>(sum.misordered) / static_cast<double>(sum.contributors));
  nearest.check_within(scene.prototype, 1);
  first_met.check_within(scene.first_met, 0.1);
}

}  // namespace sgs::test
