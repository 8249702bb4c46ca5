// Keys, ranges and the SRAM arithmetic of the accelerator's configuration.
#include "modules/accelerator_config.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/order/chunk_walk.h"
#include "algorithm/splat/constants.h"
#include "modules/messages.h"

namespace sgs {

// The sections are found by argument-dependent lookup: not in an unnamed namespace.
void visit(ConfigVisitor& v, SramConfig& c) {
  v("input_bytes", c.input_bytes, in_range(1, 1 << 30), "input buffer of all HFUs");
  v("codebook_bytes", c.codebook_bytes, in_range(0, 1 << 30), "codebook buffer");
  v("shared_bytes", c.shared_bytes, in_range(1, 1 << 30), "everything between the stages");
}

void visit(ConfigVisitor& v, VsuConfig& c) {
  v("steps_per_cycle", c.steps_per_cycle, in_range(1, 64), "tree nodes or cells a cycle");
  v("edges_per_cycle", c.edges_per_cycle, in_range(1, 64), "insertions into the ordering table");
  v("sample_step_voxels", c.sample_step_voxels, in_range(0, 10),
    "distance of samples on a ray; 0: every cell is visited");
  v("groups_ahead", c.groups_ahead, in_range(1, 64), "ordered groups waiting for the HFUs");
  v("table_bytes", c.table_bytes, in_range(8, 1 << 30), "ordering table of one group");
  v("node_cache_bytes", c.node_cache_bytes, in_range(64, 1 << 30), "cache of tree nodes");
  v("record_cache_bytes", c.record_cache_bytes, in_range(64, 1 << 30), "cache of voxel records");
  v("min_share", c.min_share, in_range(2, 1 << 20), "fewest Gaussians of a visit for one HFU");
  v("tests_per_cycle", c.tests_per_cycle, in_range(1, 64), "exact order: chunk bounds a cycle");
  v("queue_entries", c.queue_entries, in_range(kChunkNodeWidth + 1, 1 << 24),
    "exact order: queue of the front-to-back walk");
}

void visit(ConfigVisitor& v, HfuConfig& c) {
  v("cost", c.cost,
    names<FilterCost>({{"paper", FilterCost::kPaper}, {"counted", FilterCost::kCounted}}),
    "of a test: cfu_macs and ffu_macs as given, or as counted on our filters");
  v("cfus", c.cfus, in_range(1, 64), "coarse filters in one HFU");
  v("cfu_macs", c.cfu_macs, in_range(1, 10000), "multiply-accumulates of a coarse test");
  v("cfu_lanes", c.cfu_lanes, in_range(1, 10000), "MAC lanes of one CFU");
  v("cfu_depth_cycles", c.cfu_depth_cycles, in_range(1, 1000), "latency of a coarse test");
  v("ffu_macs", c.ffu_macs, in_range(1, 10000), "multiply-accumulates of a fine test");
  v("ffu_lanes", c.ffu_lanes, in_range(1, 10000), "MAC lanes of one FFU");
  v("ffu_depth_cycles", c.ffu_depth_cycles, in_range(1, 1000), "latency of a fine test");
  v("coarse_filter", c.coarse_filter, "off: every Gaussian goes to the fine filter");
  v("input_slots", c.input_slots, in_range(2, 1024), "slices in an HFU's input buffer");
  v("slice_gaussians", c.slice_gaussians, in_range(2, 1 << 20), "first halves in one slice");
  v("candidate_fifo_entries", c.candidate_fifo_entries, in_range(1, 4096), "coarse to fine");
  v("second_half_slots", c.second_half_slots, in_range(1, 1024),
    "second halves on their way or waiting");
}

void visit(ConfigVisitor& v, VqConfig& c) {
  const ConfigRange entries = in_range(1, kMaxCodebookEntries);
  v("scale_entries", c.scale_entries, entries, "most entries of the scale codebook");
  v("rotation_entries", c.rotation_entries, entries, "of the rotation codebook");
  v("dc_entries", c.dc_entries, entries, "of the codebook of base colours");
  v("sh_entries", c.sh_entries, entries, "of the codebook of the higher bands");
  v("iterations", c.iterations, in_range(0, 1000), "of k-means, at most");
  v("seed", c.seed, at_least(0), "of k-means");
}

void visit(ConfigVisitor& v, CodebookConfig& c) {
  v("banks", c.banks, in_range(1, 64), "of the codebook buffer, lines interleaved over them");
  v("line_bytes", c.line_bytes, in_range(4, 256), "of a bank, read in one cycle");
  v("latency_cycles", c.latency_cycles, in_range(1, 100), "from the last line to the FFU");
  v("preloaded", c.preloaded, "filled by an earlier frame: no traffic, no time");
}

void visit(ConfigVisitor& v, SortingConfig& c) {
  v("buffer_entries", c.buffer_entries, in_range(16, 1 << 20), "splats on chip in one unit");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096), "splats waiting from each HFU");
  v("sort_interval_cycles", c.sort_interval_cycles, in_range(1, 64), "between blocks of 16");
  v("sort_latency_cycles", c.sort_latency_cycles, in_range(1, 1000), "of the bitonic network");
  v("merge_interval_cycles", c.merge_interval_cycles, in_range(1, 64), "between merges of 8 + 8");
  v("skip_trivial", c.skip_trivial, "a list of one splat is not sent through the network");
  v("spill_block_entries", c.spill_block_entries, in_range(1, 1024), "read and written at once");
}

void visit(ConfigVisitor& v, MergeConfig& c) {
  v("entries", c.entries, in_range(2, 1 << 24), "exact order: keys that wait on chip");
  v("on_overflow", c.on_overflow,
    names<OnOverflow>({{"spill", OnOverflow::kSpill}, {"blend_early", OnOverflow::kBlendEarly}}),
    "when more keys wait: runs go to DRAM and the image stays exact, or it suffers");
  v("spill_runs", c.spill_runs, in_range(2, 1024), "spilled runs read back side by side");
  v("spill_block_entries", c.spill_block_entries, in_range(1, 1024),
    "keys read and written at once");
  v("latency_cycles", c.latency_cycles, in_range(1, 1000), "of the pipelined heap");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096),
    "sorted keys waiting from each sorting unit");
  v("output_fifo_entries", c.output_fifo_entries, in_range(1, 4096),
    "released keys waiting for each HFU");
}

void visit(ConfigVisitor& v, RenderingConfig& c) {
  v("clusters", c.clusters, in_range(1, 256), "4x4 sub-tiles blended a cycle");
  v("depth_cycles", c.depth_cycles, in_range(1, 1000), "latency of a blend");
  v("pixel_buffers", c.pixel_buffers, in_range(1, 2), "groups whose pixels are on chip");
  v("drain_pixels_per_cycle", c.drain_pixels_per_cycle, in_range(1, 4096),
    "finished pixels converted a cycle");
  v("ellipse_test", c.ellipse_test, "sub-tiles that a splat's ellipse cannot reach are skipped");
  v("subtile_tests_per_cycle", c.subtile_tests_per_cycle, in_range(1, 4096), "of the ellipse");
  v("saturation_feedback", c.saturation_feedback, "a finished group's visits are dropped upstream");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096),
    "sorted splats waiting from each sorting unit");
}

void visit(ConfigVisitor& v, MemoryPortConfig& c) {
  v("max_transaction_bytes", c.max_transaction_bytes, in_range(32, 4096),
    "a unit's longest request");
  v("max_outstanding", c.max_outstanding, in_range(1, 4096), "requests of a unit in flight");
}

namespace {

SramUse product(const std::string& name,
                std::vector<std::pair<std::uint64_t, const char*>> factors) {
  SramUse use{name, 1, ""};
  for (const auto& [value, what] : factors) {
    use.bytes *= value;
    use.arithmetic += fmt::format("{}{} {}", use.arithmetic.empty() ? "" : " x ", value, what);
  }
  return use;
}

// What buffers must be built for: degree 3, full codebooks.
SecondHalfFormat widest_format(const AcceleratorConfig& c) {
  constexpr int kMostDegree = 3;
  SecondHalfFormat format{c.encoding, kMostDegree, {}};
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    format.entries[id] = c.vq.entries(static_cast<Codebook>(id));
  }
  return format;
}

void check_budget(const char* key, std::uint64_t available, const std::vector<SramUse>& uses) {
  const std::uint64_t needed = SramBudget::total(uses);
  if (needed <= available) return;
  std::string sum;
  for (const SramUse& use : uses) {
    sum +=
        fmt::format("{}{} {} ({})", sum.empty() ? "" : " + ", use.name, use.bytes, use.arithmetic);
  }
  throw InputError(
      fmt::format("{}: {} bytes are there, {} are needed: {}", key, available, needed, sum));
}

std::vector<SramUse> paper_order_uses(const AcceleratorConfig& c) {
  return {
      product("sort buffers", {{c.sorting_units, "units"},
                               {c.sorting.buffer_entries, "splats"},
                               {kSplatEntryBytes, "B"}}),
      product("splats to sorting", {{c.hfus, "HFUs"},
                                    {c.sorting_units, "units"},
                                    {c.sorting.input_fifo_entries, "splats"},
                                    {kSplatEntryBytes, "B"}}),
      product("splats to rendering", {{c.sorting_units, "units"},
                                      {c.rendering.input_fifo_entries, "splats"},
                                      {kSplatEntryBytes, "B"}}),
      product(
          "candidates",
          {{c.hfus, "HFUs"}, {c.hfu.candidate_fifo_entries, "candidates"}, {kCandidateBytes, "B"}}),
      product("ordering table", {{c.vsu.table_bytes, "B"}}),
      // A table of b bytes orders at most b / 8 voxels; each waits as a 4-byte id.
      product("ordered voxels", {{c.vsu.groups_ahead, "groups"}, {c.vsu.table_bytes / 2, "B"}}),
      product("record cache", {{c.vsu.record_cache_bytes, "B"}}),
  };
}

std::vector<SramUse> exact_order_uses(const AcceleratorConfig& c) {
  const std::uint32_t runs = c.merge.on_overflow == OnOverflow::kSpill ? c.merge.spill_runs : 0;
  return {
      product("waiting keys", {{c.merge.entries, "keys"}, {kWaitingKeyBytes, "B"}}),
      product("spilled runs", {{runs, "runs"},
                               {2, "blocks"},
                               {c.merge.spill_block_entries, "keys"},
                               {kSpilledKeyBytes, "B"}}),
      product("walk queue", {{c.vsu.queue_entries, "entries"}, {kWalkEntryBytes, "B"}}),
      product("keys to sorting", {{c.hfus, "HFUs"},
                                  {c.sorting_units, "units"},
                                  {c.hfu.candidate_fifo_entries, "keys"},
                                  {kMergeKeyBytes, "B"}}),
      product("key sorters",
              {{c.sorting_units, "units"}, {c.chunk_gaussians, "keys"}, {kMergeKeyBytes, "B"}}),
      product("keys to merge", {{c.sorting_units, "units"},
                                {c.merge.input_fifo_entries, "keys"},
                                {kMergeKeyBytes, "B"}}),
      product("keys to HFUs",
              {{c.hfus, "HFUs"}, {c.merge.output_fifo_entries, "keys"}, {kMergeKeyBytes, "B"}}),
      product(
          "splats to rendering",
          {{c.hfus, "HFUs"}, {c.rendering.input_fifo_entries, "splats"}, {kSplatEntryBytes, "B"}}),
  };
}

}  // namespace

void visit(ConfigVisitor& v, AcceleratorConfig& c) {
  v("ordering", c.ordering,
    names<Ordering>({{"exact", Ordering::kExact}, {"paper", Ordering::kPaper}}),
    "order of blending");
  v("clock_mhz", c.clock_mhz, in_range(1, 10000), "clock of all units");
  v("group_px", c.group_px, in_range(0, kMaxGroupPx),
    "side of a pixel group, a multiple of 4; 0: the largest that fits the SRAM");
  v("voxel_size", c.voxel_size, in_range(0, 1e9),
    "world units; 0: 0.4 for a scene below 10 units across, else 2");
  v("chunk_gaussians", c.chunk_gaussians, in_range(0, 65535),
    "exact order: most Gaussians in a chunk; 0: as many as lie together in a DRAM row");
  v("encoding", c.encoding,
    names<SecondHalfEncoding>({{"raw", SecondHalfEncoding::kRaw},
                               {"half", SecondHalfEncoding::kHalf},
                               {"vq", SecondHalfEncoding::kVq},
                               {"vq_packed", SecondHalfEncoding::kVqPacked}}),
    "of second halves: 32-bit floats, 16-bit floats, codebook indices of 32 bits or packed");
  v.section("vq", c.vq, "how codebooks are made");
  v("framebuffer", c.framebuffer,
    names<FrameFormat>({{"rgb8", FrameFormat::kRgb8}, {"rgb32f", FrameFormat::kRgb32f}}),
    "pixels in DRAM");
  v("store_invisible", c.store_invisible, "also store Gaussians with opacity below 1/255");
  v("hfus", c.hfus, in_range(1, 64), "hierarchical filtering units");
  v("sorting_units", c.sorting_units, in_range(1, 16), "sorting units");
  v.section("sram", c.sram, "on-chip memory");
  v.section("vsu", c.vsu, "voxel sorting unit");
  v.section("hfu", c.hfu, "each hierarchical filtering unit");
  v.section("codebook", c.codebook, "codebook buffer of all HFUs");
  v.section("sorting", c.sorting, "each sorting unit");
  v.section("merge", c.merge, "merge unit of exact order");
  v.section("rendering", c.rendering, "rendering unit");
  v.section("memory_port", c.memory_port, "how units talk to memory");
  v.section("dram", c.dram, "memory");
}

std::uint64_t SramBudget::total(const std::vector<SramUse>& uses) {
  std::uint64_t sum = 0;
  for (const SramUse& use : uses) sum += use.bytes;
  return sum;
}

SramBudget sram_budget(const AcceleratorConfig& c) {
  SramBudget budget;
  budget.input.push_back(product("input", {{c.hfus, "HFUs"},
                                           {c.hfu.input_slots, "slots"},
                                           {c.hfu.slice_gaussians, "Gaussians"},
                                           {kFirstHalfBytes, "B"}}));
  const SramUse pixels = product("pixel state", {{c.rendering.pixel_buffers, "groups"},
                                                 {c.group_px, "px"},
                                                 {c.group_px, "px"},
                                                 {kPixelStateBytes, "B"}});
  const SecondHalfFormat format = widest_format(c);
  const SramUse second_halves =
      product("second halves",
              {{c.hfus, "HFUs"}, {c.hfu.second_half_slots, "slots"}, {format.bytes(), "B"}});
  const SramUse nodes = product("node cache", {{c.vsu.node_cache_bytes, "B"}});
  const SramUse visits =
      product("visits", {{c.hfus, "HFUs"}, {kVisitFifoEntries, "visits"}, {kVisitShareBytes, "B"}});
  budget.shared = {pixels, second_halves, nodes, visits};
  if (format.quantised()) {
    budget.shared.push_back(
        product("decoded Gaussians",
                {{c.hfus, "HFUs"}, {kDecodedEntries, "entries"}, {kDecodedBytes, "B"}}));
  }
  const std::vector<SramUse> of_order =
      c.ordering == Ordering::kPaper ? paper_order_uses(c) : exact_order_uses(c);
  budget.shared.insert(budget.shared.end(), of_order.begin(), of_order.end());
  return budget;
}

void check_codebooks(const AcceleratorConfig& config, const SecondHalfFormat& format) {
  if (!format.quantised()) return;
  std::vector<SramUse> uses;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    uses.push_back(product(
        kCodebookNames[id],
        {{format.entries[id], "entries"}, {format.entry_bytes(static_cast<Codebook>(id)), "B"}}));
  }
  check_budget("sram.codebook_bytes", config.sram.codebook_bytes, uses);
}

void AcceleratorConfig::validate() const {
  if (group_px == 0 || group_px % kSubtilePx != 0) {
    throw InputError(fmt::format("group_px: {} is not a multiple of {}", group_px, kSubtilePx));
  }
  if (hfu.slice_gaussians * kFirstHalfBytes % 32 != 0) {
    throw InputError(
        fmt::format("hfu.slice_gaussians: {} x {} B is not a whole number of 32 B bursts",
                    hfu.slice_gaussians, kFirstHalfBytes));
  }
  if (sorting.buffer_entries < 4 * sorting.spill_block_entries) {
    throw InputError(fmt::format(
        "sorting.buffer_entries: {} splats cannot merge two runs with two blocks of {} each: at "
        "least {} are needed",
        sorting.buffer_entries, sorting.spill_block_entries, 4 * sorting.spill_block_entries));
  }
  const SramBudget budget = sram_budget(*this);
  check_budget("sram.input_bytes", sram.input_bytes, budget.input);
  check_budget("sram.shared_bytes", sram.shared_bytes, budget.shared);
  dram.validate();
}

}  // namespace sgs
