// The accelerator of exact order: chunks by nearest depth, keys merged across chunks, second halves
// fetched in final order. The picture is the reference renderer's.
#pragma once

#include "modules/streaminggs/exact_config.h"
#include "modules/streaminggs/merge/merge_unit.h"
#include "modules/streaminggs/sorting/exact_sorter.h"
#include "modules/streaminggs/streaming_machine.h"
#include "modules/streaminggs/vsu/exact_vsu.h"

namespace sgs {

class ExactMachine : public StreamingMachine {
 public:
  ExactMachine(const sc_core::sc_module_name& name, const ExactConfig& config,
               const StreamingJob& job, const BuiltFor& built_for, const BuildOptions& options);

 private:
  void add_fifos(const ExactConfig& config);
  void make_sorters(const ExactConfig& config);
  void bind(OnOverflow on_overflow);
  void publish_units(DataSheet& sheet) override;

  Fifos<FineCandidate> keys_;         // [HFU, sorting unit]
  Fifos<FineCandidate> sorted_keys_;  // [sorting unit]
  Fifos<FineCandidate> released_;     // [HFU]
  Fifos<SplatToken> splats_;          // [HFU, eye]
  ExactVsu vsu_;
  std::vector<std::unique_ptr<ExactSorter>> sorters_;
  MergeUnit merge_;
  std::vector<std::unique_ptr<FinishedSubtiles>> finished_subtiles_;  // [eye]
  FinishedSubtiles untold_;  // for VSU with blend_early: there what waits decides the picture
};

// Bytes that the spill region must have: two runs of all keys, and what VSU's queue puts aside.
std::uint64_t exact_spill_bytes(const SceneLayout& layout);

}  // namespace sgs
