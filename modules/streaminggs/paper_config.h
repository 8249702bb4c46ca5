// What can be chosen about the machine of paper order.
#pragma once

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

  // The paper's memories, and the multiply-accumulates that it states.
  PaperConfig() {
    sram = {16 * 1024, 250 * 1024, 89 * 1024};
    hfu.cost = FilterCost::kPaper;
    // What fits the paper's 89 KB with pixels in float.
    hfu.candidate_fifo_entries = 14;
    rendering.cluster_queue_entries = 3;
  }
};

void visit(ConfigVisitor& v, PaperConfig& config);

// FIFOs between its units, beside those of visits.
struct PaperFifos {
  FifoKind<FineCandidate> candidates;
  FifoKind<SplatToken> splats, sorted;
  explicit PaperFifos(const PaperConfig& config);
};

// What its units and the FIFOs between them say that they take, for any scene that is stored so.
SramUses sram_uses(const PaperConfig& config, const StorageConfig& storage);

}  // namespace sgs
