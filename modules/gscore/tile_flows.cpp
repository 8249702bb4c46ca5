// Conversion and tile tests run with the counting scalar.
#include "modules/gscore/tile_flows.h"

#include <array>
#include <initializer_list>
#include <memory>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/square_conic.h"
#include "modules/datapath/filter_flows.h"

namespace sgs::gscore {
namespace {

// Words that go along with a Gaussian, or a tile of it: its number.
constexpr std::size_t kBesideTileWork = 1;

void keep_box(DataFlow& flow, const TileBoxesOf<Counting>& b) {
  for (const PixelRectOf<CountingIndex>* rect : {&b.tiles, &b.parts}) {
    keep(flow, {rect->x0, rect->y0, rect->x1, rect->y1});
  }
  keep(flow, {b.box.x, b.box.y, b.box.axis_x, b.box.axis_y});
  for (const BoxLimits<Counting>* limits : {&b.tile, &b.part}) {
    keep(flow, {limits->screen_x, limits->screen_y, limits->along, limits->across});
  }
}

// An ellipse that is long enough for a box along its axes: longest_case() with other scales.
FilterCase longest_tile_case(std::uint32_t eyes) {
  FilterCase out = longest_case(eyes);
  out.gaussian.scale = {0.5F, 0.04F, 0.11F};
  return out;
}

// Inputs of a box along the ellipse's axes, without its limits.
TileBoxesOf<Counting> boxes_from_outside(DataFlow& flow) {
  constexpr int kFar = 100;
  TileBoxesOf<Counting> boxes{};
  for (PixelRectOf<CountingIndex>* rect : {&boxes.tiles, &boxes.parts}) {
    *rect = {input_index(flow, 0), input_index(flow, 0), input_index(flow, kFar),
             input_index(flow, kFar)};
  }
  boxes.box.used = true;
  boxes.box.x = input(flow, 100.5F);
  boxes.box.y = input(flow, 90.25F);
  boxes.box.axis_x = input(flow, 0.8F);
  boxes.box.axis_y = input(flow, 0.6F);
  return boxes;
}

BoxLimits<Counting> wide_limits(DataFlow& flow) {
  constexpr float kWide = 1000;
  return {input(flow, kWide), input(flow, kWide), input(flow, kWide), input(flow, kWide)};
}

}  // namespace

FlowPart cull_flow(std::uint32_t eyes) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const FilterCase of = longest_case(eyes);
  const auto view = make_view<Counting>(of.camera);
  const auto mean = input(flow, of.gaussian.mean);
  const Counting scale = input(flow, 0.35F);
  flow.pass_beside(kBesideTileWork);
  static_cast<void>(may_touch_frame(view, frame_sides(view), mean, scale));
  keep(flow, {mean.x, mean.y, mean.z, scale});
  return whole(recorded);
}

namespace {

// What one eye sees of it. False where that is nothing.
bool convert_for_eye(DataFlow& flow, const View<Counting>& view, const TileRules& rules,
                     int sh_degree, const Gaussian<Counting>& g, const glm::vec<3, Counting>* sh,
                     bool half_records) {
  SplatOf<Counting> s{};
  TileBoxesOf<Counting> boxes{};
  if (!make_tile_geometry(view, g, rules, s, boxes)) return false;
  add_colour(view, sh_degree, g.mean, sh, s);
  keep(flow, {s.x, s.y});
  keep_box(flow, boxes);
  if (!half_records) {
    keep(flow, {s.conic_a, s.conic_b, s.conic_c, s.opacity, s.rgb.x, s.rgb.y, s.rgb.z, s.depth});
    return true;
  }
  const SquareConic<Counting> square = square_conic(s.conic_a, s.conic_b, s.conic_c);
  const SquareConic<Counting> conic = in_units(square, axis_units(square));
  for (const Counting& value :
       {conic.a, conic.lean, conic.rest, s.opacity, s.rgb.x, s.rgb.y, s.rgb.z, s.depth}) {
    keep(flow, {narrowed<CountingHalf>(value).counting()});
  }
  return true;
}

}  // namespace

FlowPart convert_flow(const TileRules& rules, const FineRecord& stored, bool half_records,
                      std::uint32_t eyes) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const FilterCase of = longest_tile_case(eyes);
  Gaussian<Counting> g{};
  g.mean = input(flow, of.gaussian.mean);
  g.scale = input(flow, of.gaussian.scale);
  for (std::size_t k = 0; k < g.quat.size(); ++k) g.quat[k] = input(flow, of.gaussian.quat[k]);
  g.opacity = input(flow, of.gaussian.opacity);
  std::array<glm::vec<3, Counting>, 16> sh;
  for (auto& coefficient : sh) coefficient = input(flow, glm::vec3(1.0F));
  flow.pass_beside(kBesideTileWork);
  if (stored.quaternion_words < g.quat.size()) restore_largest(flow, g.quat);

  const auto left = make_view<Counting>(of.camera);
  const auto convert = [&](const View<Counting>& view) {
    return convert_for_eye(flow, view, rules, stored.sh_degree, g, sh.data(), half_records);
  };
  if (convert(left) && eyes > 1) convert(right_eye(left));
  return whole(recorded);
}

FlowPart tile_test_flow(int tiles_at_once) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  TileBoxesOf<Counting> boxes = boxes_from_outside(flow);
  boxes.tile = wide_limits(flow);
  const CountingIndex x = input_index(flow, 3), y = input_index(flow, 5);
  for (int k = 0; k < tiles_at_once; ++k) {
    static_cast<void>(touches_tile(boxes, k == 0 ? x : x + CountingIndex(k), y));
  }
  // The next tiles of the row, or the first of the next row.
  const CountingIndex next_x = x + CountingIndex(tiles_at_once), next_y = y + CountingIndex(1);
  static_cast<void>(next_x < boxes.tiles.x1);
  static_cast<void>(next_y < boxes.tiles.y1);
  keep(flow, {x, y, next_x, next_y});
  flow.pass_beside(kBesideTileWork);
  return whole(recorded);
}

FlowPart part_test_flow(const TileRules& rules) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  TileBoxesOf<Counting> boxes = boxes_from_outside(flow);
  boxes.part = wide_limits(flow);
  const CountingIndex x = input_index(flow, 3), y = input_index(flow, 5);
  static_cast<void>(part_bitmap(boxes, rules, x, y));
  keep(flow, {x, y});
  flow.pass_beside(kBesideTileWork);
  return whole(recorded);
}

}  // namespace sgs::gscore
