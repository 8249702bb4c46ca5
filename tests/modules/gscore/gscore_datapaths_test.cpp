// What stands beside lanes because of the formats that numbers come and go in, and how many lanes
// keep the pace of blending; by hand.
#include "modules/gscore/gscore_datapaths.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>

namespace sgs::gscore {
namespace {

std::uint32_t comparators(const Datapath& path) {
  for (const BesideLanes& beside : path.beside) {
    if (beside.kind == "comparator") return beside.operations;
  }
  return 0;
}

// Of what was counted by running the code: a conversion takes two operations, a rounding three, a
// split four.
std::uint64_t counted(const Datapath& path) {
  std::map<std::string, std::uint64_t> n(path.counts.begin(), path.counts.end());
  CHECK(n["exponentials"] == 0);
  return n["comparisons"] + 2 * n["conversions"] + 3 * n["roundings"] + 4 * n["splits"] +
         n["scalings"] + n["index_adds"] + n["logarithms"];
}

std::uint64_t beside_counted(const Datapath& path) { return comparators(path) - counted(path); }

struct Formats {
  const char* name;
  NumberFormat features;
  BlendPrecision precision;
  std::uint64_t convert, drain;  // operations of comparators that no code was counted for
  int conic;                     // -1: there is none
};

TEST_CASE("gscore datapaths: comparators that change formats") {
  // An opacity in two places is scaled, 1. Of pixels in 16 bits four numbers are widened, 2 each.
  // Of a record in halves seven are, for blending in floats, and three scaled.
  constexpr auto kHalf = NumberFormat::kHalf, kSingle = NumberFormat::kSingle;
  for (const Formats& of :
       {Formats{"halves", kHalf, BlendPrecision::kHalf, 0, 8, -1},
        Formats{"fixed point of halves", kHalf, BlendPrecision::kFixed, 0, 8, -1},
        Formats{"floats of halves", kHalf, BlendPrecision::kSingle, 0, 0, 7 * 2 + 3},
        Formats{"floats", kSingle, BlendPrecision::kSingle, 1, 0, 1},
        Formats{"halves of floats", kSingle, BlendPrecision::kHalf, 1, 8, 1}}) {
    INFO(of.name);
    GscoreConfig config;
    config.tiles.features = of.features;
    config.rendering.precision = of.precision;
    CHECK(beside_counted(cull_pipeline(config)) == 0);
    CHECK(beside_counted(convert_pipeline(config, 1)) == of.convert);
    CHECK(beside_counted(tile_test_pipeline(config)) == 0);
    CHECK(beside_counted(part_test_pipeline(config)) == 0);
    // A block's corner is two whole numbers.
    CHECK(beside_counted(corner_pipeline(config)) == 2 * 2);
    CHECK(beside_counted(blend_pipeline(config)) == 0);
    CHECK(beside_counted(drain_pipeline(config)) == of.drain);
    const std::optional<Datapath> conic = conic_pipeline(config);
    REQUIRE(conic.has_value() == (of.conic >= 0));
    if (conic) CHECK(beside_counted(*conic) == static_cast<std::uint64_t>(of.conic));
    const bool in_16_bits = of.precision != BlendPrecision::kSingle;
    CHECK(blend_pipeline(config).lane == (in_16_bits ? "fp16_lane" : "fp32_lane"));
  }
}

TEST_CASE("gscore datapaths: as many lanes as keep the pace") {
  GscoreConfig config;
  config.tiles.features = NumberFormat::kSingle;
  for (const std::uint32_t turns : {1U, 3U}) {
    for (const int across : {1, 2, 4}) {
      INFO(turns << " cycles a block, " << across << " parts across");
      config.rendering.core_lanes = 0;
      const std::uint32_t macs = blend_pipeline(config).used_macs;
      CHECK(blend_pipeline(config).lanes == macs);
      config.rendering.core_lanes = (macs + turns - 1) / turns;
      config.tiles.subtiles_across = across;
      CHECK(blend_pipeline(config).interval_cycles() == turns);
      // The blocks of a part, and one.
      const auto blocks = static_cast<std::uint64_t>(16 / (across * across));
      CHECK(conic_pipeline(config)->interval_cycles() <= blocks * turns);
      CHECK(corner_pipeline(config).interval_cycles() <= turns);
      Datapath fewer = *conic_pipeline(config);
      if (fewer.lanes > 1) {
        --fewer.lanes;
        CHECK(fewer.interval_cycles() > blocks * turns);
      }
      fewer = corner_pipeline(config);
      CHECK(fewer.lanes == (turns == 1 ? fewer.used_macs : 1));
    }
  }
  config.rendering.drain_pixels_per_cycle = 3;
  CHECK(drain_pipeline(config).copies == 3);
  CHECK(drain_pipeline(config).interval_cycles() == 1);
}

}  // namespace
}  // namespace sgs::gscore
