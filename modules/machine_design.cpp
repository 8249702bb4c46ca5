#include "modules/machine_design.h"

#include "algorithm/files/input_error.h"

namespace sgs {

FrameJob MachineDesign::stream(const StoredScene&, const std::vector<Camera>&) const {
  throw InputError("--stream: this machine draws single frames, expected one that draws streams");
}

}  // namespace sgs
