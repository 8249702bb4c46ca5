// A row is closed with the last column that is known to want it.
#pragma once

#include "modules/dram/page_policy.h"

namespace sgs {

class ClosedPage : public PagePolicy {
 public:
  bool close_after(std::uint32_t, bool more_hits) const override { return !more_hits; }
  void on_hit(std::uint32_t) override {}
  void on_activate(std::uint32_t, std::uint32_t, bool) override {}
};

}  // namespace sgs
