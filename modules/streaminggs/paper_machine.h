// The accelerator of paper order (StreamingGS, DAC 2025): voxels in topological order of the rays,
// splats sorted inside each voxel, nothing corrected across voxels.
#pragma once

#include "modules/streaminggs/paper_config.h"
#include "modules/streaminggs/sorting/paper_sorter.h"
#include "modules/streaminggs/streaming_machine.h"
#include "modules/streaminggs/vsu/paper_vsu.h"

namespace sgs {

class PaperMachine : public StreamingMachine {
 public:
  PaperMachine(const sc_core::sc_module_name& name, const PaperConfig& config,
               const StreamingJob& job, const BuiltFor& built_for, const BuildOptions& options);

 private:
  void add_fifos(const PaperConfig& config);
  void make_sorters(const PaperConfig& config);
  void bind(std::uint32_t lists_of_part);
  void publish_units(DataSheet& sheet) override;

  const PaperSorterConfig sorting_;
  Fifos<FineCandidate> candidates_;  // [fetch]
  Fifos<SplatToken> splats_;         // [list, fetch]
  Fifos<SplatToken> sorted_;         // [list]
  PaperVsu vsu_;
  std::vector<std::unique_ptr<PaperSorter>> sorters_;  // [list]: those of a part one after another
};

}  // namespace sgs
