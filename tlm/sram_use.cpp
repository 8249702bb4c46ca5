// Products and sums of on-chip memory.
#include "tlm/sram_use.h"

#include <fmt/format.h>

namespace sgs {

SramUse sram_use(const char* name, const char* memory, const SramFactors& factors) {
  SramUse use{name, memory, 1, ""};
  for (const auto& [value, what] : factors) {
    use.bytes *= value;
    use.arithmetic += fmt::format("{}{} {}", use.arithmetic.empty() ? "" : " x ", value, what);
  }
  return use;
}

std::uint64_t sram_bytes(const SramUses& uses, const std::string& memory) {
  std::uint64_t sum = 0;
  for (const SramUse& use : uses) sum += use.memory == memory ? use.bytes : 0;
  return sum;
}

std::string sram_sum(const SramUses& uses, const std::string& memory) {
  std::string sum;
  for (const SramUse& use : uses) {
    if (use.memory != memory) continue;
    sum +=
        fmt::format("{}{} {} ({})", sum.empty() ? "" : " + ", use.name, use.bytes, use.arithmetic);
  }
  return sum;
}

}  // namespace sgs
