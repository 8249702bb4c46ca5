// Keys of the codebook buffer that all HFUs share.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

struct CodebookConfig {
  std::uint32_t banks = 8;
  std::uint32_t line_bytes = 16;
  std::uint32_t latency_cycles = 3;
  bool preloaded = false;
};

inline void visit(ConfigVisitor& v, CodebookConfig& c) {
  v("banks", c.banks, in_range(1, 64), "of the codebook buffer, lines interleaved over them");
  v("line_bytes", c.line_bytes, in_range(4, 256),
    "of a bank, read in one cycle; an HFU takes one line a cycle");
  v("latency_cycles", c.latency_cycles, in_range(1, 100), "from the last line to the FFU");
  v("preloaded", c.preloaded, "filled by an earlier frame: no traffic, no time");
}

// Decoded Gaussians between the codebook buffer and each FFU: one being read, one waiting.
constexpr std::uint32_t kDecodedEntries = 2;
constexpr std::uint32_t kDecodedBytes =
    4 * (3 + 1 + 7 + 1 + 48);  // centre, index, shape, opacity, SH

}  // namespace sgs
