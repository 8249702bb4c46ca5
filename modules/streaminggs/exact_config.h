// Parameters of the machine of exact order.
#pragma once

#include "algorithm/memory/storage_config.h"
#include "modules/streaminggs/fifo_kind.h"
#include "modules/streaminggs/merge/merge_config.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/sorting/sorting_config.h"
#include "modules/streaminggs/streaming_config.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "tlm/sram_use.h"

namespace sgs {

struct ExactConfig : StreamingConfig {
  ExactVsuConfig vsu;
  SortingNetworkConfig sorting;
  MergeConfig merge;

  // The fastest that a search over the real scenes found in the area of the preset `paper`
  // (scripts/explore.py).
  ExactConfig() {
    group_width_px = group_height_px = 96;
    sram = {3840, 0, 359680};  // the 355 KB of the paper: what is not taken is not built
    sorting_units = 1;
    hfu.slice_gaussians = 8;
    hfu.input_slots = 5;
    hfu.cfu_lanes = 2;
    hfu.candidate_fifo_entries = 18;  // 14 are under test in the CFUs, and marks
    hfu.second_half_slots = 8;
    rendering.cluster_lanes = 56;
    rendering.pixel_buffers = 1;
    rendering.input_fifo_entries = 20;  // splats in an FFU's pipeline, one every 18 cycles
    rendering.begin_lanes = 11;
    rendering.span_lanes = 10;
    rendering.span_slots = 48;  // in the pipeline of spans, one every few cycles
  }
};

inline void visit(ConfigVisitor& v, ExactConfig& c) {
  visit_head(v, c);
  v("eyes", c.hfu.eyes, in_range(1, 2),
    "2, set by --stereo: each has its own FFUs, rendering unit and pixels; all else serves both");
  v.section("vsu", c.vsu, "voxel sorting unit");
  v.section("sorting", c.sorting, "network of each sorting unit");
  v.section("merge", c.merge, "merge unit");
  visit_tail(v, c);
}

// FIFOs between its units, beside those of visits.
struct ExactFifos {
  FifoKind<FineCandidate> keys, sorted_keys, released;
  FifoKind<SplatToken> splats;
  explicit ExactFifos(const ExactConfig& config);
};

// SRAM of its units and of the FIFOs between them, enough for any scene that is stored so.
SramUses sram_uses(const ExactConfig& config, const StorageConfig& storage);

}  // namespace sgs
