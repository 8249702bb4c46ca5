// Cycles of the ordering table, by hand.
#include "modules/streaminggs/vsu/ordering_cycles.h"

#include <catch2/catch.hpp>

namespace sgs::test {

TEST_CASE("ordering cycles: a chain of reads takes a cycle each, banks of one address give one") {
  const auto cycles_of = [](OrderingTable& table, OrderingTable::Chain& chain,
                            std::uint32_t voxel) {
    const OrderingAccesses before = table.accesses();
    table.add(chain, voxel);
    return meeting_cycles(before, table.accesses());
  };
  for (const std::uint32_t banks : {1U, 2U}) {
    CAPTURE(banks);
    OrderingTable table(30);
    OrderingTable::Chain chain, again, fork;
    CHECK(cycles_of(table, chain, 5) == 1);  // its slot is free
    CHECK(cycles_of(table, chain, 6) == 1);
    // Numbers 0 and 1, edge 0: its record, the edge and the list's head, which lie in bank 0.
    CHECK(writing_cycles(table, banks) == (banks == 1 ? 3 : 2));
    CHECK(cycles_of(table, again, 5) == 2);  // slot, record
    CHECK(cycles_of(table, again, 6) == 3);  // slot and the record before, record, edge
    CHECK(writing_cycles(table, banks) == 0);
    cycles_of(table, fork, 5);
    cycles_of(table, fork, 7);  // number 2, edge 1, in front of edge 0
    OrderingTable::Chain third;
    cycles_of(table, third, 5);
    CHECK(cycles_of(table, third, 6) == 4);  // behind two edges
    table.order();
    // Of each voxel its record and two levels; two edges one behind the other, each beside the
    // record that the one before names, and the last record. Edge 1 names number 2, which lies in
    // bank 0 as both edges do.
    CHECK(ordering_cycles(table, banks) == 3 * (table.ready_levels() + 1) + 1 + 2 + 1);
  }
}

}  // namespace sgs::test
