// Counts of bursts by the state in which they found their rows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sgs {

// Hit: the row was open. Miss: the bank was closed. Conflict: another row was open and had to be
// closed first. The first burst after an activate carries its outcome, the others are hits.
enum class RowOutcome : std::uint8_t { kHit, kMiss, kConflict };

struct RowCounts {
  std::array<std::uint64_t, 3> bursts{};  // by outcome

  void count(RowOutcome outcome) { ++bursts[static_cast<std::size_t>(outcome)]; }
  std::uint64_t of(RowOutcome outcome) const { return bursts[static_cast<std::size_t>(outcome)]; }
  std::uint64_t total() const { return bursts[0] + bursts[1] + bursts[2]; }
};

}  // namespace sgs
