// sweep_record.h: what a result says of its point, to people.
#include "testbench/streaminggs/sweep/sweep_record.h"

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

namespace sgs {
namespace {

TEST_CASE("sweep record: in short it says which point, and why it has no report") {
  const std::vector<std::pair<PointInWords, std::string>> cases = {
      {{"truck.ply", "", "", "", "exact", {}}, "truck.ply exact"},
      {{"truck.ply", "truck.json", "3", "64x48", "paper", {"hfus=2", "dram.memspec=ddr"}},
       "truck.ply view 3 64x48 paper hfus=2 dram.memspec=ddr"}};
  for (const auto& [point, said] : cases) {
    CHECK(in_short(line_of_refused("k", point, "too few")) == said + ": too few");
    CHECK(in_short(line_of_failed("k", point, "killed", 2)) == said + ": killed");
  }
}

}  // namespace
}  // namespace sgs
