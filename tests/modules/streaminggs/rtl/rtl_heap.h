// A heap in Verilog, to which operations are given, a cycle at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace sgs::test {

// A key's words: what is compared, then the rest.
struct RtlKey {
  std::uint64_t compared = 0;
  std::array<std::uint32_t, 6> rest{};
  bool operator==(const RtlKey& other) const {
    return compared == other.compared && rest == other.rest;
  }
};

struct RtlHeapLevel {
  std::uint64_t nodes_read = 0, nodes_written = 0;
};

// Which of the heaps in heaps.v.
enum class RtlHeapKind {
  kOfMerge,  // 512 keys of 32 B
  kFew,      // 11 keys of 12 B: what is compared, and a word
};
constexpr std::size_t kKeysOfMergeHeap = 512, kKeysOfFew = 11;

class RtlHeap {
 public:
  explicit RtlHeap(RtlHeapKind kind);
  ~RtlHeap();
  RtlHeap(RtlHeap&&) noexcept;
  RtlHeap& operator=(RtlHeap&&) = delete;

  // As they are in this cycle.
  std::size_t size() const;
  RtlKey nearest() const;
  RtlKey farthest() const;

  // What begins in this cycle: one of these, at most.
  void insert(const RtlKey& key);
  void delete_nearest();
  void delete_farthest();
  // Also beside an insert.
  void clear();

  void step();                                                         // to the next cycle
  const std::vector<RtlHeapLevel>& levels() const { return levels_; }  // [level], the root's is 0

 private:
  struct Module;
  std::unique_ptr<Module> module_;
  const RtlHeapKind kind_;
  std::vector<RtlHeapLevel> levels_;
};

}  // namespace sgs::test
