// Waiting for the end of an instant, one delta cycle after the other.
#include "tlm/instant_end.h"

#include <algorithm>

namespace sgs {

namespace {
int alive = 0;  // in this process, which simulates once
}  // namespace

InstantEnd::InstantEnd(const sc_core::sc_module_name& name) : sc_module(name) {
  if (alive > 0) SC_REPORT_ERROR("/sgs/instant_end", "a simulation can have only one");
  ++alive;
  SC_METHOD(on_delta);
  sensitive << delta_;
  dont_initialize();
}

InstantEnd::~InstantEnd() { --alive; }

void InstantEnd::ask_for(Arbiter& arbiter) {
  if (asked_.empty()) delta_.notify(sc_core::SC_ZERO_TIME);
  if (std::find(asked_.begin(), asked_.end(), &arbiter) == asked_.end()) asked_.push_back(&arbiter);
}

void InstantEnd::on_delta() {
  if (sc_core::sc_pending_activity_at_current_time()) {
    delta_.notify(sc_core::SC_ZERO_TIME);
    return;
  }
  deciding_.swap(asked_);
  for (Arbiter* arbiter : deciding_) arbiter->decide();
  deciding_.clear();
}

}  // namespace sgs
