// The filters run with the counting scalar.
#include "modules/datapath/filter_flows.h"

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/square_conic.h"
#include "algorithm/splat/visible_extents.h"

namespace sgs {
namespace {

Gaussian<Counting> input(DataFlow& flow, const Gaussian<float>& g) {
  Gaussian<Counting> out{};
  out.mean = input(flow, g.mean);
  out.scale = input(flow, g.scale);
  for (std::size_t k = 0; k < g.quat.size(); ++k) out.quat[k] = input(flow, g.quat[k]);
  out.opacity = input(flow, g.opacity);
  return out;
}

// Words that go along with an item.
constexpr std::size_t kBesideCoarse = 3;  // storage slot, two words of the first half
constexpr std::size_t kBesideFine = 2;    // storage slot, visit
}  // namespace

// No two values of the camera are equal and none is 0, so that no two operations coincide.
FilterCase longest_case(std::uint32_t eyes) {
  FilterCase out;
  out.camera.width = 256;
  out.camera.height = 192;
  out.camera.focal_x = 250;
  out.camera.focal_y = 240;
  out.camera.position = {1, 2, 3};
  const glm::dvec3 z = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.2, 0.9, 0.1)));
  out.camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
  if (eyes > 1) out.camera.eyes_apart = 0.06;
  // In the middle of the frame, some 20 px wide; the group begins 10 px farther right and below.
  const glm::dvec3 mean = out.camera.position + 4.0 * z;
  out.gaussian = {glm::vec3(mean), {0.3F, 0.25F, 0.35F}, {0.8F, 0.36F, 0.48F, 0}, 0.9F};
  out.group = {138, 106, 170, 138};
  return out;
}

FlowPart coarse_flow(CoarseBoundBy bound_by, const FilterCase& tested, std::uint32_t across) {
  const auto flow = std::make_shared<DataFlow>();
  std::vector<View<Counting>> eyes = {make_view<Counting>(tested.camera)};
  if (eyes.front().eyes > 1) eyes.push_back(right_eye(eyes.front()));
  const auto mean = input(*flow, tested.gaussian.mean);
  const VisibleExtents known = visible_extents(tested.gaussian);
  // Recorded whatever it says.
  const auto run = [&](const auto& bound) {
    if (!bound.in_front) return;
    keep(*flow, {bound.depth});
    const PixelRect& group = tested.group;
    const int parts = static_cast<int>(across);
    const int width = (group.x1 - group.x0) / parts, height = (group.y1 - group.y0) / parts;
    for (int part = 0; part < parts * parts; ++part) {
      const int x = group.x0 + part % parts * width, y = group.y0 + part / parts * height;
      static_cast<void>(touches(bound, PixelRect{x, y, x + width, y + height}));
    }
  };
  if (bound_by == CoarseBoundBy::kLargestScale) {
    const Counting scale_max = input(*flow, known.scale_max);
    for (const View<Counting>& view : eyes) run(coarse_bound(view, mean, scale_max));
  } else {
    const auto extent = input(*flow, known.extent);
    const Counting scale_max = input(*flow, known.scale_max);
    std::vector<ReachedPixelsOf<Counting>> reached;
    for (const View<Counting>& view : eyes) {
      const auto bound = extent_bound(view, mean, extent, scale_max);
      run(bound);
      if (bound.in_front) reached.push_back(reached_pixels(bound, tested.group));
    }
    if (reached.size() > 1) static_cast<void>(of_both(reached[0], reached[1]));
  }
  keep(*flow, {mean.x, mean.y, mean.z});
  flow->pass_beside(kBesideCoarse);
  return whole(flow);
}

void restore_largest(DataFlow& flow, std::array<Counting, 4>& quat) {
  auto& [largest, x, y, z] = quat;
  largest = moved_by_units(largest_component<Counting>({x, y, z}), input_index(flow, 0));
}

FineFlow fine_flow(const FilterCase& tested, const FineRecord& record) {
  const auto flow = std::make_shared<DataFlow>();
  const auto left = make_view<Counting>(tested.camera);
  const auto view = left.eyes > 1 ? right_eye(left) : left;
  Gaussian<Counting> gaussian = input(*flow, tested.gaussian);
  std::array<glm::vec<3, Counting>, 16> sh;
  for (auto& coefficient : sh) coefficient = input(*flow, glm::vec3(1.0F));
  flow->pass_beside(kBesideFine);
  if (record.quaternion_words < gaussian.quat.size()) restore_largest(*flow, gaussian.quat);
  const std::size_t decoded = flow->size();

  SplatOf<Counting> splat{};
  const bool on_screen = make_geometry(view, gaussian, splat);
  const std::size_t geometry_end = flow->size();
  const bool kept = on_screen && reaches_group(splat, tested.group);
  const std::size_t test_end = flow->size();
  if (kept) add_colour(view, record.sh_degree, gaussian.mean, sh.data(), splat);
  keep(*flow, {splat.x, splat.y, splat.depth, splat.conic_a, splat.conic_b, splat.conic_c,
               splat.opacity, splat.rgb.x, splat.rgb.y, splat.rgb.z});
  return {whole(flow),
          {flow, 0, decoded, {}},
          {flow, decoded, geometry_end, {}},
          {flow, geometry_end, test_end, {}},
          {flow, test_end, flow->size(), {}}};
}

FlowPart rounding_flow() {
  constexpr std::size_t kBeside = 5;  // words: centre, depth, index, footprint
  const auto flow = std::make_shared<DataFlow>();
  const SquareConic<Counting> square =
      square_conic(input(*flow, 0.03F), input(*flow, 0.01F), input(*flow, 0.05F));
  const SquareConic<Counting> conic = in_units(square, axis_units(square));
  const auto rgb = input(*flow, glm::vec3(0.1F, 0.2F, 0.3F));
  for (const Counting& value :
       {conic.a, conic.lean, conic.rest, input(*flow, 0.9F), rgb.x, rgb.y, rgb.z}) {
    keep(*flow, {narrowed<CountingHalf>(value).counting()});
  }
  flow->pass_beside(kBeside);
  return whole(flow);
}

}  // namespace sgs
