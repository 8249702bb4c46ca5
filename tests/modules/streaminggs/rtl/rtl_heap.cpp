// The model that Verilator makes, without SystemC, whose headers want another clock of it.
#include "tests/modules/streaminggs/rtl/rtl_heap.h"

#include "Vheaps.h"

namespace sgs::test {
namespace {

constexpr int kBanks = 4;

// The first word of all is the highest.
template <class Words>
RtlKey key_of(const Words& words, int count) {
  RtlKey key;
  key.compared = std::uint64_t{words[count - 1]} << 32U | words[count - 2];
  for (int i = 0; i < count - 2; ++i) key.rest[static_cast<std::size_t>(i)] = words[count - 3 - i];
  return key;
}
template <class Words>
void set_key(Words& words, int count, const RtlKey& key) {
  words[count - 1] = static_cast<std::uint32_t>(key.compared >> 32U);
  words[count - 2] = static_cast<std::uint32_t>(key.compared);
  for (int i = 0; i < count - 2; ++i) words[count - 3 - i] = key.rest[static_cast<std::size_t>(i)];
}

}  // namespace

struct RtlHeap::Module : Vheaps {
  using Vheaps::Vheaps;
};

RtlHeap::RtlHeap(RtlHeapKind kind)
    : module_(std::make_unique<Module>()),
      kind_(kind),
      levels_(kind == RtlHeapKind::kOfMerge ? 9 : 3) {
  module_->reset = 1;
  step();
  module_->reset = 0;
  levels_.assign(levels_.size(), {});
}
RtlHeap::~RtlHeap() = default;
RtlHeap::RtlHeap(RtlHeap&&) noexcept = default;

std::size_t RtlHeap::size() const {
  return kind_ == RtlHeapKind::kOfMerge ? module_->size : module_->few_size;
}
RtlKey RtlHeap::nearest() const {
  return kind_ == RtlHeapKind::kOfMerge ? key_of(module_->nearest, 8)
                                        : key_of(module_->few_nearest, 3);
}
RtlKey RtlHeap::farthest() const {
  return kind_ == RtlHeapKind::kOfMerge ? key_of(module_->farthest, 8)
                                        : key_of(module_->few_farthest, 3);
}

void RtlHeap::insert(const RtlKey& key) {
  if (kind_ == RtlHeapKind::kOfMerge) {
    set_key(module_->key, 8, key);
    module_->begins = module_->inserts = 1;
  } else {
    set_key(module_->few_key, 3, key);
    module_->few_begins = module_->few_inserts = 1;
  }
}
void RtlHeap::delete_nearest() {
  (kind_ == RtlHeapKind::kOfMerge ? module_->begins : module_->few_begins) = 1;
}
void RtlHeap::delete_farthest() {
  delete_nearest();
  (kind_ == RtlHeapKind::kOfMerge ? module_->at_high : module_->few_at_high) = 1;
}
void RtlHeap::clear() {
  (kind_ == RtlHeapKind::kOfMerge ? module_->clears : module_->few_clears) = 1;
}

void RtlHeap::step() {
  module_->clock = 0;
  module_->eval();
  const std::uint32_t reads = kind_ == RtlHeapKind::kOfMerge ? module_->reads : module_->few_reads;
  const std::uint32_t writes =
      kind_ == RtlHeapKind::kOfMerge ? module_->writes : module_->few_writes;
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const auto of_level = [&](std::uint32_t banks) {
      return static_cast<std::uint64_t>(
          __builtin_popcount(banks >> (kBanks * (level - 1)) & ((1U << kBanks) - 1)));
    };
    levels_[level].nodes_read += of_level(reads);
    levels_[level].nodes_written += of_level(writes);
  }
  module_->clock = 1;
  module_->eval();
  module_->begins = module_->inserts = module_->at_high = module_->clears = 0;
  module_->few_begins = module_->few_inserts = module_->few_at_high = module_->few_clears = 0;
}

}  // namespace sgs::test
