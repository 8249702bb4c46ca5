// The time of the codebook buffer (codebook_buffer.h) without a kernel: the load, and of a record
// the lines of its entries, of each codebook the mean of all. Not in it: readers that want one
// bank.
#pragma once

#include <cstdint>

#include "modules/streaminggs/hfu/codebook_buffer.h"
#include "tlm/port_estimate.h"

namespace sgs {

class CodebookEstimate {
 public:
  CodebookEstimate(const CodebookConfig& config, const SecondHalfFormat& format,
                   const RegionSpan& codebooks, PortEstimate port);

  std::uint64_t loaded_at() const { return work_.counters.loaded_at_cycle; }
  std::uint32_t latency_cycles() const { return config_.latency_cycles; }

  // Cycles of the next record's lines.
  std::uint64_t read_record();

  CodebookBuffer::Work work() const;

 private:
  const CodebookConfig config_;
  double lines_[kCodebookCount] = {};  // of a record
  double lines_of_record_ = 0, lines_read_ = 0;
  CodebookBuffer::Work work_;
};

}  // namespace sgs
