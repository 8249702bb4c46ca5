// Registers of a counter, and multiplexers by which a word comes from one of several memories or
// registers.
#pragma once

#include <cstdint>

#include "tlm/data_sheet.h"

namespace sgs {

// Bits of a counter that takes the values 0 to most.
constexpr std::uint32_t counter_bits(std::uint64_t most) {
  std::uint32_t bits = 0;
  for (; most > 0; most /= 2) ++bits;
  return bits;
}

struct Selection {
  std::uint64_t sources = 1;  // words of which one is taken
  double bits = 0;            // of one word
  double at_once = 1;         // words in a cycle
};

// Multiplexers of two, a tree of them for each bit. words: taken so far, each by a path through it.
inline void publish_selection(DataSheet& sheet, const char* component, const Selection& of,
                              double words) {
  if (of.sources < 2) return;
  sheet.part(component, "select_bit", of.bits * static_cast<double>(of.sources - 1) * of.at_once,
             1);
  sheet.operations(component, "select_bit", of.bits * counter_bits(of.sources - 1) * words);
}

}  // namespace sgs
