// The ordering table against orders computed by hand and against the chains themselves.
#include "algorithm/order/ordering_table.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <stdexcept>

namespace sgs {
namespace {

using Voxels = std::vector<std::uint32_t>;

TEST_CASE("ordering table: one chain is its own order") {
  OrderingTable table(100);
  table.add_chain({42, 7, 99});
  CHECK(table.order() == Voxels{42, 7, 99});
  CHECK(table.voxel_count() == 3);
  CHECK(table.edge_count() == 2);
  CHECK(table.sram_bytes() == 3 * 8 + 2 * 4);
}

TEST_CASE("ordering table: nothing, and rays that meet nothing") {
  OrderingTable table(10);
  CHECK(table.order().empty());
  table.add_chain({});
  CHECK(table.order().empty());
  CHECK(table.edges_offered() == 0);
}

TEST_CASE("ordering table: among voxels that are ready the one first met goes first") {
  OrderingTable table(100);
  // Renamed: 50 -> 0, 10 -> 1, 30 -> 2, 20 -> 3.
  table.add_chain({50, 10});
  table.add_chain({30, 20});
  // Ready at first: 0 and 2. 0 goes, which frees 1; 1 before 2; then 3.
  CHECK(table.order() == Voxels{50, 10, 30, 20});

  table.clear();
  // Renamed: 5 -> 0, 6 -> 1, 7 -> 2, 8 -> 3. 3 before 0, 1 free: 1, then 2 (freed by 1), 3, 0.
  table.add_chain({5});
  table.add_chain({6, 7});
  table.add_chain({8, 5});
  CHECK(table.order() == Voxels{6, 7, 8, 5});
}

TEST_CASE("ordering table: a diamond") {
  OrderingTable table(10);
  table.add_chain({1, 2, 4});
  table.add_chain({1, 3, 4});
  CHECK(table.order() == Voxels{1, 2, 3, 4});
  CHECK(table.edge_count() == 4);
  CHECK(table.edges_offered() == 4);
}

TEST_CASE("ordering table: an edge counts once, however many rays offer it") {
  OrderingTable table(10);
  table.add_chain({1, 2});
  table.add_chain({1, 2});
  table.add_chain({3});
  table.add_chain({1, 2});
  CHECK(table.edge_count() == 1);
  CHECK(table.edges_offered() == 3);
}

TEST_CASE("ordering table: clear forgets voxels, edges and the chain before") {
  OrderingTable table(10);
  table.add_chain({1, 2});
  table.clear();
  table.add_chain({1, 2});
  CHECK(table.edge_count() == 1);
  table.clear();
  table.add_chain({2, 1});
  CHECK(table.order() == Voxels{2, 1});
  CHECK(table.sram_bytes() == 2 * 8 + 4);
}

TEST_CASE("ordering table: a chain that does not fit is told, whatever it lacks room for") {
  OrderingTable voxels(10, 8), edges(10, 2 * 8 + 4 + 3);
  CHECK(voxels.add_chain({1}));
  CHECK_FALSE(voxels.add_chain({2}));
  voxels.clear();
  CHECK(voxels.add_chain({2}));
  CHECK(edges.add_chain({1, 2}));
  CHECK(edges.add_chain({1}));
  CHECK_FALSE(edges.add_chain({2, 1}));  // an edge of 4 B where 3 are left
}

TEST_CASE("ordering table: chains that contradict each other are found out") {
  OrderingTable table(10);
  table.add_chain({1, 2});
  table.add_chain({2, 3});
  table.add_chain({3, 1});
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
      table.add_chain(chain);
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
