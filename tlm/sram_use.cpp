// Products and sums of on-chip memory.
#include "tlm/sram_use.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgs {

std::string SramUse::product() const {
  return count == 1 ? arithmetic : fmt::format("{} x {}", count, arithmetic);
}

SramUse sram_use(const char* name, const char* memory, const SramFactors& factors,
                 const SramShape& shape, const SramPeak& peak) {
  SramUse use{name, memory, 1, "", 1, shape, peak};
  for (const auto& [value, what] : factors) {
    use.bytes *= value;
    use.arithmetic += fmt::format("{}{} {}", use.arithmetic.empty() ? "" : " x ", value, what);
  }
  return use;
}

void add(SramUses& to, const SramUse& use, std::uint64_t count) {
  const auto same = std::find_if(to.begin(), to.end(), [&](const SramUse& u) {
    return u.name == use.name && u.memory == use.memory && u.bytes == use.bytes &&
           u.arithmetic == use.arithmetic && u.shape == use.shape && u.peak == use.peak;
  });
  if (same != to.end()) {
    same->count += count * use.count;
  } else {
    to.push_back(use);
    to.back().count *= count;
  }
}

void add(SramUses& to, const SramUses& uses, std::uint64_t count) {
  for (const SramUse& use : uses) add(to, use, count);
}

namespace {

bool takes_of(const SramUse& use, const std::string& memory) {
  return use.memory == memory && !use.in_registers();
}

}  // namespace

std::uint64_t sram_bytes(const SramUses& uses, const std::string& memory) {
  std::uint64_t sum = 0;
  for (const SramUse& use : uses) sum += takes_of(use, memory) ? use.total_bytes() : 0;
  return sum;
}

std::string sram_sum(const SramUses& uses, const std::string& memory) {
  std::string sum;
  for (const SramUse& use : uses) {
    if (!takes_of(use, memory)) continue;
    sum += fmt::format("{}{} {} ({})", sum.empty() ? "" : " + ", use.name, use.total_bytes(),
                       use.product());
  }
  return sum;
}

std::string largest_uses(const SramUses& uses, const std::string& memory) {
  constexpr std::size_t kNamed = 4;
  SramUses all;
  for (const SramUse& use : uses) {
    if (takes_of(use, memory)) all.push_back(use);
  }
  if (all.size() <= kNamed) return sram_sum(all, memory);
  std::stable_sort(all.begin(), all.end(), [](const SramUse& a, const SramUse& b) {
    return a.total_bytes() > b.total_bytes();
  });
  const std::size_t more = all.size() - kNamed;
  all.resize(kNamed);
  return fmt::format("{} + {} smaller", sram_sum(all, memory), more);
}

}  // namespace sgs
