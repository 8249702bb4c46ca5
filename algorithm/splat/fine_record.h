// What of a Gaussian's record decides how much the fine filter computes.
#pragma once

#include <cstdint>

namespace sgs {

struct FineRecord {
  int sh_degree = 0;
  std::uint32_t quaternion_words = 4;  // 3: the largest component follows from the others

  friend constexpr bool operator==(const FineRecord& a, const FineRecord& b) {
    return a.sh_degree == b.sh_degree && a.quaternion_words == b.quaternion_words;
  }
};

}  // namespace sgs
