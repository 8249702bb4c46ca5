// Parameters of the codebook buffer that all HFUs share.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

struct CodebookConfig {
  std::uint32_t banks = 8;        // read side by side, lines interleaved over them
  std::uint32_t line_bytes = 16;  // of one bank, read in one cycle; an HFU takes one line a cycle
  std::uint32_t latency_cycles = 3;  // from the last line to the decoded Gaussian
  bool preloaded = false;            // filled by an earlier frame: no traffic, no time
};

void visit(ConfigVisitor& v, CodebookConfig& config);

// Decoded Gaussians between the codebook buffer and each FFU: one being read, one waiting.
constexpr std::uint32_t kDecodedEntries = 2;
constexpr std::uint32_t kDecodedBytes =
    4 * (3 + 1 + 7 + 1 + 48);  // centre, index, shape, opacity, SH

}  // namespace sgs
