// The interval heap in Verilog beside the one that units have: every key, and the nodes that are
// read and written, with an operation every two cycles.
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "algorithm/order/interval_heap.h"
#include "tests/modules/streaminggs/rtl/rtl_heap.h"

namespace sgs::test {
namespace {

struct Nearer {
  bool operator()(const RtlKey& a, const RtlKey& b) const { return a.compared < b.compared; }
};
using Heap = IntervalHeap<RtlKey, Nearer>;

class SideBySide {
 public:
  SideBySide(RtlHeapKind kind, std::size_t capacity, std::uint64_t seed)
      : rtl_(kind),
        heap_(capacity),
        rest_words_(kind == RtlHeapKind::kOfMerge ? 6 : 1),
        random_(seed) {}

  void insert(std::uint64_t compared) {
    RtlKey key{compared, {}};
    for (std::size_t i = 0; i < rest_words_; ++i)
      key.rest[i] = static_cast<std::uint32_t>(random_());
    rtl_.insert(key);
    heap_.insert(key);
    step();
  }
  void delete_nearest() {
    check_ends();
    rtl_.delete_nearest();
    heap_.delete_min();
    step();
  }
  void delete_farthest() {
    check_ends();
    rtl_.delete_farthest();
    heap_.delete_max();
    step();
  }
  void clear() {
    rtl_.clear();
    heap_.clear();
    rtl_.step();
  }
  void wait(std::uint64_t cycles) {
    for (; cycles > 0; --cycles) rtl_.step();
  }
  const Heap& heap() const { return heap_; }
  std::uint64_t keys_checked() const { return checked_; }

  // By the way that units' ledgers charge them.
  void check_accesses() {
    wait(20);
    const HeapWork& work = heap_.work();
    REQUIRE(rtl_.levels().size() == work.levels.size());
    for (std::size_t l = 1; l < work.levels.size(); ++l) {
      CAPTURE(l);
      CHECK(rtl_.levels()[l].nodes_read ==
            work.levels[l].nodes_read + work.levels[l].nodes_read_ahead);
      CHECK(rtl_.levels()[l].nodes_written == work.levels[l].nodes_written);
    }
  }

 private:
  // An operation takes two cycles. In the second one what it leaves is seen already.
  void step() {
    rtl_.step();
    check_ends();
    rtl_.step();
  }
  void check_ends() {
    ++checked_;
    const bool same =
        rtl_.size() == heap_.size() &&
        (heap_.empty() || (rtl_.nearest() == heap_.min() && rtl_.farthest() == heap_.max()));
    if (!same)
      FAIL("after " << heap_.work().operations() << " operations, " << heap_.size() << " keys");
  }

  RtlHeap rtl_;
  Heap heap_;
  const std::size_t rest_words_;
  std::mt19937_64 random_;
  std::uint64_t checked_ = 0;
};

// Filled and emptied in turn, at either end, with marks and gaps between.
void check_random(RtlHeapKind kind, std::size_t capacity, std::size_t operations,
                  std::uint64_t seed) {
  SideBySide heaps(kind, capacity, seed);
  std::mt19937_64 random(seed + 1);
  std::uint64_t slot = 0;
  for (std::size_t i = 0; i < operations; ++i) {
    const unsigned inserts_of_8 = i / (4 * capacity) % 2 == 0 ? 7 : 1;
    if (random() % 4001 == 0) heaps.clear();
    const Heap& heap = heaps.heap();
    if (heap.empty() || (random() % 8 < inserts_of_8 && !heap.full())) {
      heaps.insert(random() % 64 << 32U | slot++);
    } else if (random() % 3 > 0) {
      heaps.delete_nearest();
    } else {
      heaps.delete_farthest();
    }
    if (random() % 16 == 0) heaps.wait(random() % 5);
  }
  heaps.check_accesses();
  CHECK(heaps.keys_checked() > operations);
}

}  // namespace

TEST_CASE("interval heap in Verilog: random operations") {
  check_random(RtlHeapKind::kOfMerge, kKeysOfMergeHeap, 20'000, 1);
  check_random(RtlHeapKind::kFew, kKeysOfFew, 20'000, 2);
}

TEST_CASE("interval heap in Verilog: filled in order, in reverse, and with equal depths") {
  for (const std::uint64_t order : {0, 1, 2}) {
    SideBySide heaps(RtlHeapKind::kOfMerge, kKeysOfMergeHeap, order);
    for (std::uint64_t k = 0; k < kKeysOfMergeHeap; ++k) {
      heaps.insert(order == 0 ? k << 32U : order == 1 ? (kKeysOfMergeHeap - k) << 32U : k ^ 0x155U);
    }
    CHECK(heaps.heap().full());
    for (std::uint64_t k = 0; k < kKeysOfMergeHeap; ++k) {
      k % 3 == order ? heaps.delete_farthest() : heaps.delete_nearest();
    }
    heaps.check_accesses();
  }
}

TEST_CASE("interval heap in Verilog: many operations", "[nightly]") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    check_random(RtlHeapKind::kOfMerge, kKeysOfMergeHeap, 500'000, seed);
    check_random(RtlHeapKind::kFew, kKeysOfFew, 500'000, seed);
  }
}

}  // namespace sgs::test
