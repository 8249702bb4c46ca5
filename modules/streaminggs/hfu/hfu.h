// Hierarchical filtering unit (HFU), or those that share a fetch: coarse and fine filters. In paper
// order the one feeds the other; in exact order the keys are merged in between: the machine binds
// their ports. How many share it: the parts into which the job's groups are cut.
#pragma once

#include <systemc>

#include "modules/streaminggs/hfu/coarse_filter.h"
#include "modules/streaminggs/hfu/fine_filter.h"

namespace sgs {

class Hfu : public sc_core::sc_module {
 public:
  CoarseFilter coarse;
  FineFilter fine;

  Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const CodebookConfig& codebook,
      const FineFilterPlace& place, const UnitContext& context)
      : sc_module(name),
        coarse("coarse", config, context),
        fine("fine", config, codebook, place, context) {}

  static SramUses sram_uses(const HfuConfig& config, const BuiltFor& built_for,
                            std::uint32_t parts) {
    SramUses uses = CoarseFilter::sram_uses(config, built_for);
    add(uses, FineFilter::sram_uses(config, built_for, parts));
    return uses;
  }
  void publish(DataSheet& sheet) {
    coarse.publish(sheet);
    fine.publish(sheet);
  }
};

}  // namespace sgs
