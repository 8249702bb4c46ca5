// How often operations of an interval heap may begin, against its memories cycle by cycle.
#include "modules/streaminggs/heap_ledger.h"

#include <catch2/catch.hpp>
#include <functional>
#include <random>
#include <vector>

#include "tests/modules/streaminggs/stepped_heap.h"

namespace sgs::test {
namespace {

using Heap = IntervalHeap<std::uint32_t, std::less<>>;

// What a stepped heap did with random operations, one every `interval` cycles, and the heap itself
// with the same.
struct Stepped {
  bool same_results = false;
  std::uint32_t most_at_a_port = 0;
  std::uint64_t nodes_read = 0, nodes_written = 0;
  HeapWork work;
};

Stepped step_through(std::size_t capacity, const HeapPace& pace, int interval) {
  using What = SteppedHeap::What;
  Heap heap(capacity);
  SteppedHeap stepped(capacity, pace);
  std::vector<std::uint32_t> expected;
  std::mt19937 random(static_cast<unsigned>(capacity));
  for (int i = 0; i < 20000; ++i) {
    const unsigned inserts_of_8 = i / 500 % 2 == 0 ? 6 : 2;  // full and empty in turn
    const auto key = static_cast<std::uint32_t>(random() % 1000);
    if (random() % 997 == 0) {
      heap.clear();
      stepped.clear();
    }
    if (heap.empty() || (random() % 8 < inserts_of_8 && !heap.full())) {
      heap.insert(key);
      stepped.begin(What::kInsert, key);
    } else if (random() % 4 > 0) {
      expected.push_back(heap.delete_min());
      stepped.begin(What::kDeleteMin, 0);
    } else {
      expected.push_back(heap.delete_max());
      stepped.begin(What::kDeleteMax, 0);
    }
    const int cycles = interval + (random() % 16 == 0 ? static_cast<int>(random() % 5) : 0);
    for (int c = 0; c < cycles; ++c) stepped.step();
  }
  while (stepped.busy()) stepped.step();
  return {!stepped.lost() && stepped.results() == expected, stepped.most_at_a_port(),
          stepped.nodes_read(), stepped.nodes_written(), heap.work()};
}

constexpr HeapPace kFourBanks{4, 1}, kTwoBanks{2, 2};

}  // namespace

TEST_CASE("heap ledger: overlapped operations take a port once a cycle and come out the same") {
  for (const std::size_t capacity : {2U, 3U, 6U, 7U, 30U, 101U, 1397U}) {
    CAPTURE(capacity);
    const Stepped fast = step_through(capacity, kFourBanks, 2);
    CHECK(fast.same_results);
    CHECK(fast.most_at_a_port <= 1);
    const HeapLevelWork of_fast = fast.work.all_levels();
    CHECK(fast.nodes_read == of_fast.nodes_read + of_fast.nodes_read_ahead);
    CHECK(fast.nodes_written == of_fast.nodes_written);
    const Stepped slow = step_through(capacity, kTwoBanks, 3);
    CHECK(slow.same_results);
    CHECK(slow.most_at_a_port <= 1);
    CHECK(slow.nodes_read == slow.work.all_levels().nodes_read);
    CHECK(slow.nodes_written == slow.work.all_levels().nodes_written);
  }
}

TEST_CASE("heap ledger: less than that is too little") {
  const auto works = [](const HeapPace& pace, int interval) {
    const Stepped stepped = step_through(1397, pace, interval);
    return stepped.same_results && stepped.most_at_a_port <= 1;
  };
  CHECK_FALSE(works(kFourBanks, 1));
  CHECK_FALSE(works({2, 1}, 2));         // both candidates' children in two banks
  CHECK_FALSE(works({4, 1, false}, 2));  // what is written in the same cycle is not seen
  CHECK_FALSE(works({2, 2, false}, 3));
  CHECK_FALSE(works(kTwoBanks, 2));
  CHECK_FALSE(works({4, 2}, 2));
  CHECK(works({4, 1, false}, 3));
  CHECK(works({2, 2, false}, 4));
}

TEST_CASE("heap ledger: banks of a level") {
  CHECK(heap_banks_of_level(2) == 4);
  CHECK(heap_banks_of_level(3) == 2);
}

}  // namespace sgs::test
