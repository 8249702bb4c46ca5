// Rows stay open until another row of the bank is wanted or a refresh closes them.
#pragma once

#include "modules/dram/page_policy.h"

namespace sgs {

class OpenPage : public PagePolicy {
 public:
  bool close_after(std::uint32_t, bool) const override { return false; }
  void on_hit(std::uint32_t) override {}
  void on_activate(std::uint32_t, std::uint32_t, bool) override {}
};

}  // namespace sgs
