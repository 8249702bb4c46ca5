// Designs whose machines have no estimate.
#include "modules/machine_design.h"

#include "algorithm/input_error.h"

namespace sgs {
namespace {

constexpr const char* kNoEstimate =
    "--estimate: there is no estimate of this machine, expected `machine` exact or paper";

}  // namespace

CountedFrame MachineDesign::count(const StoredScene&, const FrameJob&, DataSheet&) const {
  throw InputError(kNoEstimate);
}

std::string MachineDesign::work_key() const { throw InputError(kNoEstimate); }

}  // namespace sgs
