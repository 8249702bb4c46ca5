// The visitor that adds up.
#include "testbench/result/sram_budget.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

class Budget : public DataSheet {
 public:
  void unit(const sc_core::sc_object& unit) override {
    check_queues();
    unit_ = unit.name();
    in_uses_.clear();
    in_queues_.clear();
  }
  void sram(const SramUse& use) override {
    add(uses_, use);
    in_uses_[use.name] += use.total_bytes();
  }
  void sram_available(const char* memory, std::uint64_t bytes) override {
    available_[memory] += bytes;
  }
  void queue(FifoChannel& queue, const char* use) override {
    in_queues_[use] += std::uint64_t{queue.capacity()} * queue.entry_bytes();
  }

  void check() {
    check_queues();
    std::set<std::string> memories;
    for (const SramUse& use : uses_) memories.insert(use.memory);
    for (const std::string& memory : memories) {
      const std::uint64_t needed = sram_bytes(uses_, memory);
      if (needed <= available_[memory]) continue;
      throw InputError(fmt::format("on-chip memory {}: {} bytes are there, {} are needed: {}",
                                   memory, available_[memory], needed, sram_sum(uses_, memory)));
    }
  }

 private:
  void check_queues() const {
    for (const auto& [use, bytes] : in_queues_) {
      const auto at = in_uses_.find(use);
      if (at != in_uses_.end() && at->second >= bytes) continue;
      throw std::logic_error(fmt::format("{}: its queues hold {} B of \"{}\", its SRAM uses {}",
                                         unit_, bytes, use, at == in_uses_.end() ? 0 : at->second));
    }
  }

  SramUses uses_;
  std::map<std::string, std::uint64_t> available_;            // [memory]
  std::map<std::string, std::uint64_t> in_uses_, in_queues_;  // bytes of this unit, [use]
  std::string unit_;
};

}  // namespace

void check_sram_budget(Machine& machine) {
  Budget budget;
  machine.publish(budget);
  budget.check();
}

}  // namespace sgs
