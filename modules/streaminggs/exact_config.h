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

  // Tuned for speed over the real scenes, step by step from what a search found
  // (scripts/explore.py), in an area somewhat below that of the preset `paper`.
  ExactConfig() {
    group_width_px = 128;
    group_height_px = 120;
    hfus = 2;
    sram = {7680, 0, 359680};  // the 355 KB of the paper: what is not taken is not built
    sorting_units = 1;
    vsu.test_lanes = 21;
    hfu.slice_gaussians = 8;
    hfu.input_slots = 10;
    hfu.cfus = 1;
    hfu.cfu_lanes = 16;
    hfu.ffu_lanes = 35;
    hfu.candidate_fifo_entries = 32;
    hfu.second_half_slots = 24;
    merge.entries = 768;
    merge.output_fifo_entries = 8;
    rendering.cluster_lanes = 84;
    rendering.pixel_buffers = 1;
    rendering.pixel_ports = 0;
    rendering.drain_on_clusters = true;
    rendering.input_fifo_entries = 40;
    rendering.begin_lanes = 11;
    rendering.span_lanes = 10;
    rendering.span_slots = 48;  // in the pipeline of spans, one every few cycles
    memory_port.max_outstanding = 24;
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
