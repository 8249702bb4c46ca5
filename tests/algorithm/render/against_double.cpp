// The two steps, printed and checked.
#include "tests/algorithm/render/against_double.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <catch2/catch.hpp>

#include "algorithm/image/quality.h"
#include "algorithm/render/blend_pass.h"
#include "algorithm/render/group_state.h"
#include "tests/algorithm/render/decisions.h"

namespace sgs::test {
namespace {

// The oracle's splats rounded to float, each in all sub-tiles of its tile rectangle.
std::vector<Splat> rounded_splats(const std::vector<OracleSplat>& ordered) {
  std::vector<Splat> out;
  const auto subtile = [](int tile) { return static_cast<std::uint16_t>(tile * kSubtilesPerTile); };
  for (const OracleSplat& s : ordered) {
    Splat splat{};
    splat.x = static_cast<float>(s.x);
    splat.y = static_cast<float>(s.y);
    splat.conic_a = static_cast<float>(s.conic[0]);
    splat.conic_b = static_cast<float>(s.conic[1]);
    splat.conic_c = static_cast<float>(s.conic[2]);
    splat.opacity = static_cast<float>(s.opacity);
    splat.rgb = s.rgb;
    splat.footprint = {subtile(s.x0), subtile(s.y0), subtile(s.x1), subtile(s.y1)};
    out.push_back(splat);
  }
  return out;
}

Image blend_in_float(const Camera& camera, const std::vector<Splat>& splats) {
  RenderResult frame(camera.width, camera.height);
  const auto tiles = pixel_groups(camera.width, camera.height, square_of(kTilePx));
  const SplatBins bins = bin_splats(cell_grid(camera.width, camera.height, square_of(kTilePx)),
                                    splats.data(), splats.size());
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
    GroupState tile(tiles[i], camera.width, camera.height);
    for (std::size_t k = bins.first[i]; k != bins.first[i + 1] && !tile.saturated(); ++k) {
      tile.blend(splats[bins.entries[k]]);
    }
    tile.store(glm::vec3(0), frame);
  });
  return frame.image;
}

}  // namespace

Image as_image(const OracleImage& oracle) {
  Image image(oracle.width, oracle.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = oracle.pixels[i];
  return image;
}

void check_against_double(const std::string& name, const Camera& camera,
                          const GaussianCloud& cloud) {
  const auto ordered = oracle_order(oracle_project(camera, cloud));
  const Image in_double = as_image(oracle_blend(camera, ordered));
  const Image in_float = blend_in_float(camera, rounded_splats(ordered));
  const double psnr = psnr_db(in_float, in_double);
  const double within = fraction_within(in_float, in_double, 1e-4);
  fmt::print("{} view {}: blending: {:.1f} dB, {:.4f} % of pixels within 1e-4, largest {:.2g}\n",
             name, camera.id, psnr, 100 * within, max_abs_error(in_float, in_double));
  CHECK(psnr >= 95);
  CHECK(within >= 0.9997);

  const Decisions d = compare_decisions(camera, cloud);
  fmt::print(
      "{} view {}: decisions: {} in front, rectangles differ {} (open to rounding {}), order {}, "
      "near plane {}, unexplained {}; largest error / bound {:.2f}\n",
      name, camera.id, d.in_front, d.rect_differs, d.rect_uncertain, d.order_differs, d.near_plane,
      d.unexplained, d.worst_share);
  INFO(d.first_unexplained);
  CHECK(d.unexplained == 0);
  // A bound that left many rectangles open would prove little.
  CHECK(static_cast<double>(d.rect_uncertain) <= 0.001 * static_cast<double>(d.in_front));
}

}  // namespace sgs::test
