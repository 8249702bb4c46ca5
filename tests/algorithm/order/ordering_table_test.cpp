// The ordering table against orders computed by hand and against the chains themselves.
#include "algorithm/order/ordering_table.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>

namespace sgs {
namespace {

using Voxels = std::vector<std::uint32_t>;

// The voxels that one ray meets; false as soon as one finds no room.
bool add_chain(OrderingTable& table, const Voxels& voxels) {
  OrderingTable::Chain chain;
  return std::all_of(voxels.begin(), voxels.end(),
                     [&](std::uint32_t voxel) { return table.add(chain, voxel); });
}

TEST_CASE("ordering table: among voxels that are ready the one first met goes first") {
  OrderingTable table(100);
  // Renamed: 50 -> 0, 10 -> 1, 30 -> 2, 20 -> 3.
  add_chain(table, {50, 10});
  add_chain(table, {30, 20});
  // Ready at first: 0 and 2. 0 goes, which frees 1; 1 before 2; then 3.
  CHECK(table.order() == Voxels{50, 10, 30, 20});

  table.clear();
  // Renamed: 5 -> 0, 6 -> 1, 7 -> 2, 8 -> 3. 3 before 0, 1 free: 1, then 2 (freed by 1), 3, 0.
  add_chain(table, {5});
  add_chain(table, {6, 7});
  add_chain(table, {8, 5});
  CHECK(table.order() == Voxels{6, 7, 8, 5});
}

TEST_CASE("ordering table: a chain that does not fit is told, whatever it lacks room for") {
  OrderingTable voxels(10, 8), edges(10, 2 * 8 + 4 + 3);
  CHECK(add_chain(voxels, {1}));
  CHECK_FALSE(add_chain(voxels, {2}));
  voxels.clear();
  CHECK(add_chain(voxels, {2}));
  CHECK(add_chain(edges, {1, 2}));
  CHECK(add_chain(edges, {1}));
  CHECK_FALSE(add_chain(edges, {2, 1}));  // an edge of 4 B where 3 are left
}

TEST_CASE("ordering table: edges in lines take no room of it, and a voxel has so many at most") {
  OrderingTable table(100, 4 * 8, 1);
  add_chain(table, {1, 2});
  add_chain(table, {1, 3});
  CHECK(add_chain(table, {1, 2}));
  CHECK_FALSE(table.added_edge());
  CHECK(table.bytes() == 3 * 8);
  CHECK(table.out_degree(0) == 2);
  CHECK(table.destinations(0) == Voxels{1, 2});
  CHECK(add_chain(table, {1, 4}));
  CHECK(table.added_edge());
  CHECK_FALSE(add_chain(table, {5}));  // a fifth voxel

  // Full words of ready voxels: what finds no room has no bit.
  Voxels all(ReadyVoxels::kWordBits);
  std::iota(all.begin(), all.end(), 0);
  OrderingTable words(100, 8 * all.size(), 1);
  CHECK(add_chain(words, all));
  CHECK_FALSE(add_chain(words, {99}));
  words.clear();
  CHECK(add_chain(words, {99, 1}));
  CHECK(words.order() == Voxels{99, 1});

  OrderingTable wide(100, OrderingTable::kUnlimited, 1);
  for (std::uint32_t to = 1; to <= kMostAdjacencyLines; ++to) CHECK(add_chain(wide, {0, to}));
  CHECK_FALSE(add_chain(wide, {0, kMostAdjacencyLines + 1}));
  wide.clear();
  CHECK(add_chain(wide, {0, 1}));
  CHECK(wide.order() == Voxels{0, 1});
  // Four records, and the source's once more for each line that begins.
  OrderingTable counted(100, OrderingTable::kUnlimited, 2);
  for (const std::uint32_t to : {2, 3, 4}) add_chain(counted, {1, to});
  CHECK(counted.accesses().writes == 4 + 2);
  CHECK(counted.written().size() == 2);
}

TEST_CASE("ordering table: every voxel of a full renaming is found") {
  std::mt19937 random(3);
  for (const std::uint64_t voxels : {1, 2, 5, 96, 512, 3000}) {
    Renaming names(voxels);
    std::vector<std::uint32_t> of;
    std::uint64_t looked_at = 0;
    const auto find = [&](std::uint32_t voxel) {
      return names.find(
          voxel, [&](std::uint32_t n) { return of[n] == voxel; }, looked_at);
    };
    while (of.size() < voxels) {
      const auto first = static_cast<std::uint32_t>(random() % 1000000);
      for (std::uint32_t v = first; v < first + 9 && of.size() < voxels; ++v) {
        const std::uint32_t slot = find(v);
        if (names.taken(slot)) continue;
        names.take(slot, static_cast<std::uint32_t>(of.size()));
        of.push_back(v);
      }
    }
    looked_at = 0;
    std::uint64_t wrong = 0;
    for (std::uint32_t n = 0; n < voxels; ++n) wrong += names.number(find(of[n])) == n ? 0 : 1;
    CHECK(wrong == 0);
    CHECK(looked_at <= 3 * voxels);
    names.clear();
    CHECK_FALSE(names.taken(find(of[0])));
  }
}

TEST_CASE("ordering table: the first of the ready voxels, against a set") {
  std::mt19937 random(4);
  for (const std::uint32_t voxels : {1U, 32U, 33U, 1024U, 1025U, 40000U}) {
    ReadyVoxels ready(voxels);
    std::set<std::uint32_t> expected;
    std::size_t wrong = 0;
    for (int i = 0; i < 3000; ++i) {
      const std::uint32_t voxel = static_cast<std::uint32_t>(random() % voxels);
      if (random() % 2 == 0) {
        ready.set(voxel);
        expected.insert(voxel);
      } else {
        ready.clear(voxel);
        expected.erase(voxel);
      }
      wrong += ready.empty() == expected.empty() ? 0 : 1;
      if (!expected.empty()) wrong += ready.first() == *expected.begin() ? 0 : 1;
    }
    CHECK(wrong == 0);
  }
  CHECK(ReadyVoxels(32).levels() == 1);
  CHECK(ReadyVoxels(1025).levels() == 3);
  CHECK(ReadyVoxels::all_words_for(512) == 16 + 1);
}

TEST_CASE("ordering table: chains that contradict each other are found out") {
  OrderingTable table(10);
  add_chain(table, {1, 2});
  add_chain(table, {2, 3});
  add_chain(table, {3, 1});
  CHECK_THROWS_AS(table.order(), std::logic_error);
}

TEST_CASE("ordering table: random chains that agree with a hidden order are all kept") {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 200; ++repeat) {
    Voxels hidden(60);
    std::iota(hidden.begin(), hidden.end(), 0U);
    std::shuffle(hidden.begin(), hidden.end(), random);
    OrderingTable table(hidden.size());
    std::vector<Voxels> chains;
    for (int k = 0; k < 30; ++k) {
      Voxels chain;
      for (const std::uint32_t voxel : hidden) {
        if (random() % 6 == 0) chain.push_back(voxel);
      }
      add_chain(table, chain);
      chains.push_back(chain);
    }
    const Voxels order = table.order();
    std::vector<std::size_t> place(hidden.size(), order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      REQUIRE(place[order[i]] == order.size());
      place[order[i]] = i;
    }
    for (const Voxels& chain : chains) {
      for (std::size_t i = 0; i < chain.size(); ++i) {
        REQUIRE(place[chain[i]] < order.size());
        if (i > 0) REQUIRE(place[chain[i - 1]] < place[chain[i]]);
      }
    }
  }
}

}  // namespace
}  // namespace sgs
