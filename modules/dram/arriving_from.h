// A note on a payload that waits out its annotated delay: which initiator it came from.
#pragma once

#include <tlm>

namespace sgs {

struct ArrivingFrom : tlm::tlm_extension<ArrivingFrom> {
  int initiator = 0;

  tlm_extension_base* clone() const override { return new ArrivingFrom(*this); }
  void copy_from(const tlm_extension_base& other) override {
    initiator = static_cast<const ArrivingFrom&>(other).initiator;
  }
};

}  // namespace sgs
