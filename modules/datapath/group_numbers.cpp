// The numbers of a group are made with the counting scalar.
#include "modules/datapath/group_numbers.h"

#include <memory>
#include <utility>

#include "algorithm/splat/counting.h"
#include "algorithm/splat/group_numbers.h"
#include "modules/datapath/counted_datapath.h"

namespace sgs {
namespace {

// No two numbers of the frame and the group are equal. The group is the last of its row.
constexpr PixelSize kFrame{250, 187}, kGroup{48, 36};
constexpr float kMiddleX = 124.25F, kMiddleY = 93.25F;

void keep_sides(DataFlow& flow, const GroupSides<Counting>& sides) {
  keep(flow, {sides.left, sides.right, sides.top, sides.bottom});
}

}  // namespace

FlowPart group_flow(GroupUse use, std::uint32_t across) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const GroupPlaceOf<CountingIndex> place{input_index(flow, 240), input_index(flow, 72)};
  const int parts = static_cast<int>(across);
  const PixelSize of_part{kGroup.width / parts, kGroup.height / parts};
  for (int part = 0; part < parts * parts; ++part) {
    const int x = part % parts * of_part.width, y = part / parts * of_part.height;
    const GroupPlaceOf<CountingIndex> at{x == 0 ? place.x : place.x + CountingIndex(x),
                                         y == 0 ? place.y : place.y + CountingIndex(y)};
    const auto pixels = group_at(at, of_part, kFrame);
    if (use == GroupUse::kRays || use == GroupUse::kPixels) {
      keep(flow, {pixels.x0, pixels.y0, pixels.x1, pixels.y1});
      continue;
    }
    const auto outer = outer_pixels<Counting>(pixels);
    keep_sides(flow, outer);
    if (use == GroupUse::kWalk) {
      keep_sides(flow, from_middle(outer, Counting(kMiddleX), Counting(kMiddleY)));
    }
  }
  if (use == GroupUse::kWalk || use == GroupUse::kRays) {
    const auto next = group_behind(place, kGroup, kFrame);
    keep(flow, {next.x, next.y});
  }
  return whole(recorded);
}

GroupNumbers group_numbers(const FlowPart& flow, const OperationLatencies& latencies) {
  GroupNumbers out;
  const OperationCounts& c = out.counts = flow.counts();
  const std::uint32_t macs = folded_macs(c);
  out.interval_cycles = std::max({macs, c.comparisons, c.index_adds, c.conversions});
  const std::uint32_t beside = comparisons(c);
  const FoldedParts parts{macs > 0 ? 1U : 0U,
                          (beside + out.interval_cycles - 1) / out.interval_cycles, 0,
                          out.interval_cycles};
  const FoldedPipeline folded = folded_pipeline(flow.steps(latencies), parts, latencies);
  const BetweenLanes between = between_lanes(folded.wiring, kSingleBits);
  out.depth_cycles = folded.schedule.cycles;
  out.register_bits = between.registers;
  out.select_bits = between.multiplexers;
  out.bits_written = between.written;
  out.bits_selected = between.selected;
  return out;
}

void GroupNumbers::publish(DataSheet& sheet, const char* component, std::uint64_t groups) const {
  const auto made = static_cast<double>(groups);
  const std::pair<const char*, std::uint32_t> kinds[] = {
      {kSingleParts.lane, folded_macs(counts)},
      {kSingleParts.comparator, counts.comparisons},
      {"adder", counts.index_adds},
      {"conversion", counts.conversions}};
  for (const auto& [kind, operations] : kinds) {
    if (operations == 0) continue;
    sheet.part(component, kind, 1, 1);
    sheet.operations(component, kind, operations * made);
  }
  sheet.part(component, "register_bit", register_bits, 1);
  sheet.operations(component, "register_bit", bits_written * made);
  sheet.part(component, "select_bit", select_bits, 1);
  sheet.operations(component, "select_bit", bits_selected * made);
}

}  // namespace sgs
