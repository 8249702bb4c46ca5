// Exact order, when more keys wait than the merge buffer holds.
#pragma once

namespace sgs {

enum class OnOverflow {
  kSpill,       // sorted runs go to DRAM and come back: the image stays exact
  kBlendEarly,  // the nearest keys are released before they are final: the image may suffer
};

}  // namespace sgs
