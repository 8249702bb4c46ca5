// The interval heap against std::multiset, whatever it holds and however it is used.
#include "algorithm/order/interval_heap.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

using namespace sgs;

namespace {

using Heap = IntervalHeap<std::uint32_t, std::less<>>;

struct Use {
  std::size_t capacity;
  std::uint32_t different_keys;
  unsigned inserts_of_8;  // of eight operations, where there is room and something to take
};

// Random operations; returns the work that the heap counted.
HeapWork check_against_multiset(const Use& use, unsigned seed, int operations) {
  Heap heap(use.capacity);
  std::multiset<std::uint32_t> expected;
  std::mt19937 random(seed);
  HeapWork work;
  for (int i = 0; i < operations; ++i) {
    const bool insert =
        expected.empty() || (random() % 8 < use.inserts_of_8 && expected.size() < use.capacity);
    if (random() % 997 == 0) {  // a group ends
      heap.clear();
      expected.clear();
    } else if (insert) {
      const auto key = static_cast<std::uint32_t>(random() % use.different_keys);
      heap.insert(key);
      expected.insert(key);
      ++work.inserts;
    } else if (random() % 2 == 0) {
      REQUIRE(heap.delete_min() == *expected.begin());
      expected.erase(expected.begin());
      ++work.delete_mins;
    } else {
      REQUIRE(heap.delete_max() == *expected.rbegin());
      expected.erase(std::prev(expected.end()));
      ++work.delete_maxs;
    }
    REQUIRE(heap.size() == expected.size());
    REQUIRE(heap.empty() == expected.empty());
    REQUIRE(heap.full() == (expected.size() == use.capacity));
    if (expected.empty()) continue;
    REQUIRE(heap.min() == *expected.begin());
    REQUIRE(heap.max() == *expected.rbegin());
  }
  CHECK(heap.work().inserts == work.inserts);
  CHECK(heap.work().delete_mins == work.delete_mins);
  CHECK(heap.work().delete_maxs == work.delete_maxs);
  return heap.work();
}

}  // namespace

TEST_CASE("interval heap: what a multiset says, of every size, with many and no equal keys") {
  for (const std::size_t capacity : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 9U, 14U, 15U, 64U, 101U, 510U}) {
    for (const std::uint32_t different : {1U, 3U, 1000U, 4000000000U}) {
      for (const unsigned inserts : {3U, 4U, 6U}) {
        CAPTURE(capacity, different, inserts);
        const HeapWork work = check_against_multiset(
            {capacity, different, inserts}, static_cast<unsigned>(capacity) + inserts, 4000);
        // No operation passes more levels than there are below the root.
        const std::uint64_t below_root = heap_levels(capacity) - 1;
        CHECK(work.all_levels().nodes_written <= work.operations() * below_root);
        CHECK(work.all_levels().nodes_read + work.all_levels().nodes_read_ahead <=
              (work.inserts + 4 * (work.delete_mins + work.delete_maxs)) * below_root);
        CHECK(work.comparisons <= work.operations() * 2 * (below_root + 1));
      }
    }
  }
}

TEST_CASE("interval heap: full and emptied from either end, it sorts") {
  for (const std::size_t capacity : {1U, 2U, 7U, 30U, 31U, 1952U}) {
    for (const bool farthest_first : {false, true}) {
      CAPTURE(capacity, farthest_first);
      Heap heap(capacity);
      const auto count = static_cast<std::uint32_t>(capacity);
      for (int round = 0; round < 2; ++round) {  // the second time over what the first left there
        for (std::uint32_t i = 0; i < count; ++i) heap.insert(i * 7919U % (count + 1));
        REQUIRE(heap.full());
        std::uint32_t last = farthest_first ? ~0U : 0;
        for (std::uint32_t i = 0; i < count; ++i) {
          const std::uint32_t key = farthest_first ? heap.delete_max() : heap.delete_min();
          REQUIRE((farthest_first ? key <= last : key >= last));
          last = key;
        }
        REQUIRE(heap.empty());
      }
    }
  }
}

TEST_CASE("interval heap: work of single operations, by hand") {
  Heap heap(6);  // a root and two children
  for (const std::uint32_t key : {5U, 1U}) heap.insert(key);
  CHECK(heap.work().comparisons == 1);
  CHECK(heap.work().all_levels().nodes_read == 0);  // the root is in registers
  heap.insert(9);                                   // takes 5's place at the high end, 5 sinks
  CHECK(heap.work().comparisons == 3);
  CHECK(heap.work().all_levels().nodes_read == 0);  // nothing is there yet
  CHECK(heap.work().all_levels().nodes_written == 1);
  heap.insert(3);  // to the other child, which is emptier
  CHECK(heap.work().all_levels().nodes_written == 2);
  CHECK(heap.delete_min() == 1);  // 3 and 5 are compared, 3 rises
  CHECK(heap.work().comparisons == 6);
  CHECK(heap.work().all_levels().nodes_read == 2);
  CHECK(heap.work().all_levels().nodes_written == 2);  // the root, and the child is empty
  CHECK(heap.delete_max() == 9);                       // only 5 is below: nothing to compare
  CHECK(heap.work().comparisons == 6);
  CHECK(heap.work().all_levels().nodes_read == 3);
  CHECK(heap.work().all_levels().nodes_read_ahead == 0);
  CHECK(heap.min() == 3);
  CHECK(heap.max() == 5);
}

TEST_CASE("interval heap: levels, their nodes and the bits of counts") {
  CHECK(heap_levels(1) == 1);
  CHECK(heap_levels(2) == 1);
  CHECK(heap_levels(3) == 2);
  CHECK(heap_levels(6) == 2);
  CHECK(heap_levels(7) == 3);
  CHECK(heap_levels(1952) == 10);  // 2 (2^10 - 1) = 2,046
  CHECK(heap_count_bits(2, 0) == 0);
  CHECK(heap_count_bits(6, 0) == 2);  // up to 2
  CHECK(heap_count_bits(6, 1) == 0);
  for (const std::uint64_t capacity : {6U, 14U, 62U, 1345U}) {
    const std::uint32_t levels = heap_levels(capacity);
    std::uint64_t nodes = 0;
    for (std::uint32_t level = 0; level < levels; ++level) {
      const double most = 2.0 * (std::exp2(levels - level - 1) - 1);
      CHECK(heap_count_bits(capacity, level) == std::ceil(std::log2(most + 1)));
      CHECK(heap_nodes(capacity, level) > 0);
      nodes += heap_nodes(capacity, level);
    }
    CHECK(nodes == (capacity + 1) / 2);
    CHECK(heap_nodes(capacity, levels) == 0);
  }
  CHECK(heap_nodes(1345, 8) == 256);
  CHECK(heap_nodes(1345, 9) == 673 - 511);
}
