// The FIFOs of one arrow of the pipeline, before they are made: the budget adds them up and the top
// makes them.
#pragma once

#include <cstdint>

#include "modules/streaminggs/built_for.h"
#include "tlm/timed_fifo.h"

namespace sgs {

template <class T>
struct FifoKind {
  const char* name;  // name of the SRAM use
  const char* what;  // the entries are
  std::uint32_t count, entries, latency_cycles;
  const char* key = nullptr;  // configuration key of the number of entries; null: fixed
  std::uint32_t entry_bytes = EntryBytes<T>::value;  // bytes that hardware keeps of an entry here

  SramUse each() const {
    return sram_use(name, kSharedSram, {{entries, what}, {entry_bytes, "B"}}, {8 * entry_bytes},
                    kOneOfEach);
  }
  SramUse all() const {
    SramUse use = each();
    use.count = count;
    return use;
  }
};

// One of them.
template <class T>
class FifoOfKind : public TimedFifo<T> {
 public:
  FifoOfKind(const char* name, const ClockDomain& clock, const FifoKind<T>& kind)
      : TimedFifo<T>(name, clock, kind.entries, kind.latency_cycles), bytes_(kind.entry_bytes) {}
  std::uint32_t entry_bytes() const override { return bytes_; }

 private:
  const std::uint32_t bytes_;
};

}  // namespace sgs
