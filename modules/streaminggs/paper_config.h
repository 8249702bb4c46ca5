// Parameters of the machine of paper order.
#pragma once

#include <algorithm>

#include "algorithm/memory/storage_config.h"
#include "modules/streaminggs/fifo_kind.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/sorting/sorting_config.h"
#include "modules/streaminggs/streaming_config.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "tlm/sram_use.h"

namespace sgs {

struct PaperConfig : StreamingConfig {
  PaperVsuConfig vsu;
  PaperSorterConfig sorting;
  double stated_area_mm2 = 0;

  // The paper's memories, and the multiply-accumulates that it states.
  PaperConfig() {
    sram = {16 * 1024, 250 * 1024, 89 * 1024};
    hfu.cost = FilterCost::kPaper;
    hfu.slice_gaussians = 128;              // 2 KB, twice in each HFU
    group_width_px = group_height_px = 64;  // with pixels of 8 B: 32 KB of the paper's 89
    rendering.precision = BlendPrecision::kHalf;
    rendering.pixel_buffers = 1;
    rendering.cluster_queue_entries = 4;
    memory_port.max_outstanding = 8;
    hfu.candidate_fifo_entries = 30;  // 28 are under test in the CFUs, and marks
    rendering.input_fifo_entries = 4;
  }

  // Lists that are sorted side by side: those of one part of the groups, and of all. A network
  // serves several lists in turn where there are more lists than networks.
  std::uint32_t lists_of_part() const { return std::max(1U, sorting_units / parts()); }
  std::uint32_t lists() const { return parts() * lists_of_part(); }
  std::uint32_t lists_of_network() const { return lists() / sorting_units; }
};

inline void visit(ConfigVisitor& v, PaperConfig& c) {
  visit_head(v, c);
  v("fetch", c.fetch, names<Fetch>({{"shared", Fetch::kShared}, {"split", Fetch::kSplit}}),
    "shared: one feeds all HFUs, each with its part of the group; split: each its part of a visit");
  v("stated_area_mm2", c.stated_area_mm2, in_range(0, 1e6),
    "area that is published for the machine, which reports name beside its own; 0: none");
  v("splats", c.splats,
    names<NumberFormat>({{"fp32", NumberFormat::kSingle}, {"fp16", NumberFormat::kHalf}}),
    "in FIFOs and sort buffers: 32-bit floats; or conic, opacity and colour in 16 bits");
  v.section("vsu", c.vsu, "voxel sorting unit");
  v.section("sorting", c.sorting, "each sorting unit");
  visit_tail(v, c);
}

// Throw InputError: what cannot be built; rays farther apart than a group is long, once it has a
// size.
void check(const PaperConfig& config);
void check_rays(const PaperConfig& config);

// FIFOs between its units, beside those of visits.
struct PaperFifos {
  FifoKind<FineCandidate> candidates;
  FifoKind<SplatToken> splats, sorted;
  explicit PaperFifos(const PaperConfig& config);
};

// SRAM of its units and of the FIFOs between them, enough for any scene that is stored so.
SramUses sram_uses(const PaperConfig& config, const StorageConfig& storage);

}  // namespace sgs
