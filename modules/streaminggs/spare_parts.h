// Parts of a machine that a frame never fed, with the number that would do: the same pixels, as
// fast as before or nearly so, for less area.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "tlm/data_sheet.h"

namespace sgs {

// what: key of the saving; key: of the configuration; most: that the frame took; fewest: that the
// key may be beside the other keys.
inline void publish_spare(DataSheet& sheet, const char* what, const char* key, std::uint64_t there,
                          std::uint64_t most, std::uint64_t fewest) {
  const std::uint64_t enough = std::max(most, fewest);
  if (enough >= there) return;
  sheet.left_out(what, "never fed in this frame", there - enough,
                 fmt::format("{}={} would do, if every frame is like this one", key, enough));
}

// Units that take jobs in turn, the first of them first. fed(unit): true if any job came to it.
template <class Units, class Fed>
std::uint64_t units_fed(const Units& units, Fed&& fed) {
  std::uint64_t enough = 0;
  for (std::size_t at = 0; at < units.size(); ++at) {
    if (fed(*units[at])) enough = at + 1;
  }
  return enough;
}

}  // namespace sgs
