// What can be chosen about the machine of exact order.
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

  // The paper's 355 KB, divided as exact order needs them: shallow input, large groups.
  ExactConfig() {
    group_width_px = group_height_px = 128;
    sram = {3840, 0, 359680};
    hfu.slice_gaussians = 8;
    hfu.input_slots = 5;
    hfu.second_half_slots = 16;
    rendering.pixel_buffers = 1;
    rendering.input_fifo_entries = 14;  // splats in an FFU's pipeline, one every 18 cycles
    rendering.span_slots = 32;          // in the pipeline of spans, one every few cycles
  }
};

void visit(ConfigVisitor& v, ExactConfig& config);

// FIFOs between its units, beside those of visits.
struct ExactFifos {
  FifoKind<FineCandidate> keys, sorted_keys, released;
  FifoKind<SplatToken> splats;
  explicit ExactFifos(const ExactConfig& config);
};

// What its units and the FIFOs between them say that they take, for any scene that is stored so.
SramUses sram_uses(const ExactConfig& config, const StorageConfig& storage);

}  // namespace sgs
