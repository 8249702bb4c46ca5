// Lines of the mean record.
#include "modules/streaminggs/hfu/codebook_estimate.h"

namespace sgs {

CodebookEstimate::CodebookEstimate(const CodebookConfig& config, const SecondHalfFormat& format,
                                   const RegionSpan& codebooks, PortEstimate port)
    : config_(config) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    double lines = 0;
    for (std::uint32_t index = 0; index < format.entries[id]; ++index) {
      lines += lines_of(format.entry(static_cast<Codebook>(id), index), config.line_bytes).count;
    }
    lines_[id] = lines / format.entries[id];
    lines_of_record_ += lines_[id];
  }
  if (config.preloaded) return;
  const std::uint32_t bytes = format.codebook_bytes();
  const PortEstimate::Access load = port.read(0, codebooks.base, bytes, codebooks.region);
  work_.counters.bytes_loaded = bytes;
  work_.counters.loaded_at_cycle = load.answered;
  work_.traffic = port.traffic();
}

std::uint64_t CodebookEstimate::read_record() {
  const auto before = static_cast<std::uint64_t>(lines_read_);
  lines_read_ += lines_of_record_;
  ++work_.counters.records;
  return static_cast<std::uint64_t>(lines_read_) - before;
}

CodebookBuffer::Work CodebookEstimate::work() const {
  CodebookBuffer::Work work = work_;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    work.counters.lines_of[id] =
        static_cast<std::uint64_t>(lines_[id] * static_cast<double>(work.counters.records));
  }
  work.counters.lines = static_cast<std::uint64_t>(lines_read_);
  return work;
}

}  // namespace sgs
