// Messages between the units, one bounded FIFO each arrow of the pipeline. kSramBytes: bytes that
// hardware keeps of a message that waits.
#pragma once

#include <cstdint>

#include "algorithm/memory/record_split.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// A visit is one voxel streamed for one pixel group; visits are numbered through the frame. Behind
// a group's last visit comes an end-of-group mark that takes a number of its own.
// kRejected holds the place of a key whose Gaussian turned out not to touch the group.
enum class Mark : std::uint8_t { kNone, kEndOfVisit, kEndOfGroup, kRejected };

// VSU -> HFU: this HFU's share of a visit (which may be empty), or the end of a group.
struct VisitShare {
  static constexpr std::uint32_t kSramBytes = 16;
  std::uint32_t group = 0;
  std::uint32_t visit = 0;
  std::uint32_t first = 0, count = 0;  // storage slots
  Mark mark = Mark::kNone;
  float release_below = 0;  // exact order: nothing nearer comes after this visit
};

// Coarse filter -> (sorting -> merge, in exact order) -> second-half fetch -> fine filter.
struct FineCandidate {
  // Slot, centre, what is carried, and depth or parts: paper order sorts later.
  static constexpr std::uint32_t kSramBytes = 28;
  std::uint32_t group = 0;
  std::uint32_t visit = 0;
  std::uint32_t slot = 0;
  float depth = 0;          // v_z: with the slot the key of exact order
  float release_below = 0;  // with kEndOfVisit, in exact order
  float mean_x = 0, mean_y = 0, mean_z = 0;
  CarriedWords carried{};    // words of the first half that the second half needs
  std::uint64_t ticket = 0;  // read of the second half
  std::uint32_t buffer = 0;  // where it lands
  std::uint32_t parts = 1;   // parts of the group, or eyes, that it may touch, a bit each
  GroupReach reach{};        // in exact order, while it is a key (kKeyBytes)
  Mark mark = Mark::kNone;   // with a mark there is no Gaussian
};

// A candidate that is sorted and merged as a key of exact order: with the sub-tiles that it may
// reach, in either eye. Eyes are told in the top bits of the slot's word.
constexpr std::uint32_t kKeyBytes = FineCandidate::kSramBytes + sizeof(GroupReach);

// HFU -> sorting -> rendering.
struct SplatToken {
  static constexpr std::uint32_t kSramBytes = kSplatEntryBytes;
  Splat splat{};
  std::uint32_t group = 0;
  std::uint32_t visit = 0;
  Mark mark = Mark::kNone;  // with a mark there is no splat
};

constexpr std::uint32_t kVisitFifoEntries = 4;  // visits waiting for each HFU

}  // namespace sgs
