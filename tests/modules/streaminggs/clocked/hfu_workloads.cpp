// Messages and items of the visits of a scene.
#include "tests/modules/streaminggs/clocked/hfu_workloads.h"

#include "algorithm/memory/record_split.h"
#include "testbench/units/job_memory.h"

namespace sgs::test {
namespace {

SplitFirstHalf first_half(const tb::TestScene& scene, std::uint32_t slot) {
  const SceneLayout& layout = scene.job.layout;
  return read_first_half(layout.split, scene.image.at(layout.first_halves.address(slot)));
}

// Lines of the record's entries, codebook after codebook, interleaved over the banks.
std::vector<std::uint32_t> banks_of(const tb::HfuPlan& plan, std::uint32_t slot) {
  const SceneLayout& layout = plan.scene.job.layout;
  const SecondHalfFormat& format = layout.second_half;
  std::vector<std::uint32_t> banks;
  if (!format.quantised()) return banks;
  const CodebookIndices indices =
      read_indices(layout.split, format, first_half(plan.scene, slot).carried,
                   plan.scene.image.at(layout.second_halves.address(slot)));
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const EntryRange entry = format.entry(static_cast<Codebook>(id), indices[id]);
    const std::uint32_t line_bytes = plan.codebook.line_bytes;
    for (std::uint32_t line = entry.begin / line_bytes;
         line * line_bytes < entry.begin + entry.bytes; ++line) {
      banks.push_back(line % plan.codebook.banks);
    }
  }
  return banks;
}

}  // namespace

tb::SceneShape shape_of(const PixelSize& group) {
  tb::SceneShape shape;
  shape.gaussians = 1500;
  shape.group = group;
  shape.width_px = 3 * group.width;
  shape.height_px = group.height;
  shape.order = StorageOrder::kChunks;
  return shape;
}

ClockedTransfer read_of(const RecordArray& records, std::uint32_t first, std::size_t count) {
  return {records.address(first), count * records.record_bytes};
}

Takings only_marks(const Takings& all) {
  Takings marks;
  for (const Taken& taken : all) {
    if (taken.what >= kMarks && taken.what < kRejectedItem) marks.push_back(taken);
  }
  return marks;
}

tb::HfuPlan fine_plan(const tb::SceneShape& shape, const FineHardware& hardware,
                      std::uint32_t visit_gaussians, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::HfuPlan plan = tb::hfu_plan_of(tb::random_scene(random, shape));
  plan.config.ffus = hardware.ffus;
  plan.config.ffu_lanes = 16;
  plan.config.ffu_macs = 16 * hardware.test_cycles;
  plan.config.ffu_depth_cycles = hardware.depth_cycles;
  plan.config.second_half_slots = hardware.slots;
  const auto groups = static_cast<std::uint32_t>(plan.scene.job.groups.size());
  std::uint32_t visit = 0;
  for (std::uint32_t first = 0; first + visit_gaussians <= 1000; first += visit_gaussians) {
    plan.shares.push_back(
        {first * groups / 1000, visit++, first, visit_gaussians, Mark::kEndOfVisit});
  }
  return plan;
}

std::vector<FineCandidate> candidates_of(const tb::HfuPlan& plan) {
  std::vector<FineCandidate> candidates;
  for (const VisitShare& share : plan.shares) {
    for (std::uint32_t slot = share.first; slot < share.first + share.count; ++slot) {
      const SplitFirstHalf first = first_half(plan.scene, slot);
      FineCandidate c;
      c.group = share.group;
      c.visit = share.visit;
      c.slot = slot;
      c.mean_x = first.mean.x;
      c.mean_y = first.mean.y;
      c.mean_z = first.mean.z;
      c.carried = first.carried;
      candidates.push_back(c);
    }
    FineCandidate mark;
    mark.group = share.group;
    mark.visit = share.visit;
    mark.mark = share.mark;
    candidates.push_back(mark);
  }
  return candidates;
}

std::vector<FineItem> clocked_candidates(const tb::HfuPlan& plan) {
  std::vector<bool> passes(plan.scene.job.layout.gaussian_count(), false);
  tb::HfuPlan unfiltered = plan;
  unfiltered.config.coarse_filter = false;
  for (const VisitShare& share : plan.shares) {
    for (const Splat& splat : tb::expect(unfiltered, share).splats) passes[splat.index] = true;
  }
  std::vector<FineItem> items;
  for (const FineCandidate& c : candidates_of(plan)) {
    FineItem item;
    item.group = c.group;
    item.is_mark = c.mark != Mark::kNone;
    if (item.is_mark) {
      item.what = kMarks + c.visit;
    } else {
      item.read = read_of(plan.scene.job.layout.second_halves, c.slot, 1);
      item.banks = banks_of(plan, c.slot);
      item.what = c.slot;
      item.passes = passes[c.slot];
    }
    items.push_back(std::move(item));
  }
  return items;
}

std::uint64_t what_of_splat(const SplatToken& t) {
  if (t.mark == Mark::kRejected) return kRejectedItem;
  return t.mark == Mark::kNone ? t.splat.index : kMarks + t.visit;
}

}  // namespace sgs::test
