// Filling of the codebook buffer, and who reads which bank when.
#include "modules/hfu/codebook_buffer.h"

#include <algorithm>

namespace sgs {

CodebookBuffer::CodebookBuffer(const sc_core::sc_module_name& name, const CodebookConfig& config,
                               const ClockDomain& clock, const FrameJob& job, MemoryPort& port)
    : sc_module(name),
      config_(config),
      job_(job),
      port_(port),
      load_activity_(std::string(this->name()) + ".load", clock),
      bytes_(job.layout.second_half.codebook_bytes()) {
  SC_THREAD(load);
}

void CodebookBuffer::preload(const std::byte* bytes) {
  std::copy_n(bytes, bytes_.size(), bytes_.begin());
  full_ = true;
}

void CodebookBuffer::load() {
  if (full_) return;
  const std::uint64_t base = job_.layout[Region::kCodebooks].base;
  start_read(port_, load_activity_, base, bytes_.data(), static_cast<std::uint32_t>(bytes_.size()),
             region_id(Region::kCodebooks));
  await_all(port_, load_activity_);
  load_activity_.enter(ActivityState::kStarved);
  counters_.bytes_loaded = bytes_.size();
  counters_.loaded_at_cycle = load_activity_.clock().now_cycles();
  full_ = true;
  filled_.notify(sc_core::SC_ZERO_TIME);
}

std::uint64_t CodebookBuffer::Reservations::take(std::uint32_t bank, std::uint64_t cycle) {
  while (true) {
    Slot& slot = slots_[cycle % kWindowCycles];
    if (slot.cycle != cycle + 1) slot = {cycle + 1, 0};
    const std::uint64_t bit = std::uint64_t{1} << bank;
    if ((slot.taken & bit) == 0) {
      slot.taken |= bit;
      return cycle;
    }
    ++cycle;
  }
}

// Lines of an entry, one a cycle from `cycle` on; returns the cycle behind the last.
std::uint64_t CodebookBuffer::take_lines(const EntryRange& entry, std::uint64_t cycle) {
  if (entry.bytes == 0) return cycle;
  const std::uint32_t first = entry.begin / config_.line_bytes;
  const std::uint32_t last = (entry.begin + entry.bytes - 1) / config_.line_bytes;
  for (std::uint32_t line = first; line <= last; ++line) {
    const std::uint64_t taken = reservations_.take(line % config_.banks, cycle);
    counters_.conflict_cycles += taken - cycle;
    ++counters_.lines;
    cycle = taken + 1;
  }
  return cycle;
}

void CodebookBuffer::read_entries(const CodebookIndices& indices, Activity& reader) {
  if (!full_) {
    reader.enter(ActivityState::kStarved);
    while (!full_) sc_core::wait(filled_);
    reader.clock().align();
    reader.enter(ActivityState::kBusy);
  }
  const SecondHalfFormat& format = job_.layout.second_half;
  const std::uint64_t now = reader.clock().now_cycles();
  std::uint64_t cycle = now;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    cycle = take_lines(format.entry(static_cast<Codebook>(id), indices[id]), cycle);
  }
  ++counters_.records;
  reader.work(cycle - now);
}

void CodebookBuffer::trace(sc_core::sc_trace_file* file) const {
  load_activity_.trace(file);
  sc_core::sc_trace(file, full_, std::string(name()) + ".full");
}

}  // namespace sgs
