// The machines of this project. Nothing else outside their rooms names one, but tests.
#include "modules/machines.h"

#include "modules/gscore/gscore_design.h"
#include "modules/streaminggs/exact_design.h"
#include "modules/streaminggs/paper_design.h"

namespace sgs {
namespace {

template <class Design>
std::unique_ptr<MachineDesign> make() {
  return std::make_unique<Design>();
}

}  // namespace

const std::vector<MachineKind>& machine_kinds() {
  static const std::vector<MachineKind> kinds = {
      {"exact", "chunks by depth, keys merged across them: the reference picture",
       &make<ExactDesign>},
      {"paper", "voxels in topological order of the rays (StreamingGS, DAC 2025)",
       &make<PaperDesign>},
      {"gscore", "tile-centric: lists of all tiles in memory (GSCore, ASPLOS 2024)",
       &make<gscore::GscoreDesign>},
  };
  return kinds;
}

}  // namespace sgs
