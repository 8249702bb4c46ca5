// When a row is closed before another is wanted. One policy a file; see open_page.h,
// closed_page.h, adaptive_page.h.
#pragma once

#include <cstdint>
#include <memory>

#include "modules/dram/dram_config.h"

namespace sgs {

class PagePolicy {
 public:
  virtual ~PagePolicy() = default;

  // True if the column command about to be sent to `bank` (counted over ranks) closes its row.
  // `more_hits`: requests for the row are waiting besides this one.
  virtual bool close_after(std::uint32_t bank, bool more_hits) const = 0;

  // Events: a request found its row open; a row was opened. `conflict`: another row had to be
  // closed for it.
  virtual void on_hit(std::uint32_t bank) = 0;
  virtual void on_activate(std::uint32_t bank, std::uint32_t row, bool conflict) = 0;
};

std::unique_ptr<PagePolicy> make_page_policy(const DramConfig& config, std::uint32_t banks);

}  // namespace sgs
