// What stands beside lanes because of the formats that numbers come and go in, and how many lanes
// keep the pace of blending; by hand.
#include "modules/gscore/gscore_datapaths.h"

#include <catch2/catch.hpp>

namespace sgs::gscore {
namespace {

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
  // Of two tiles in the same memories one is read in a cycle of the other's turn.
  CHECK(drain_pipeline(config).interval_cycles() == 3);
  config.rendering.core_lanes = 0;
  CHECK(drain_pipeline(config).interval_cycles() == 1);
}

TEST_CASE("gscore datapaths: memories of pixels, and whose lanes drain them") {
  GscoreConfig config;
  config.rendering.precision = BlendPrecision::kSingle;
  for (const bool is_folded : {false, true}) {
    config.rendering.core_lanes = is_folded ? 60 : 0;
    config.rendering.pixel_buffers = 2;
    CHECK(shares_pixel_memories(config) == is_folded);
    CHECK(ports_of_pixels(config) == SramPorts::kReadAndWrite);
    CHECK(drain_row_cycles(config, 16) == (is_folded ? 3 * 16 : 16));
    CHECK(drain_pipeline(config).lanes_of.empty());
    config.rendering.pixel_buffers = 1;
    CHECK_FALSE(shares_pixel_memories(config));
    CHECK(ports_of_pixels(config) == (is_folded ? SramPorts::kOne : SramPorts::kReadAndWrite));
    CHECK(drain_pipeline(config).lanes_of == "blend");
    config.rendering.drain_pixels_per_cycle = 4;
    CHECK(drain_row_cycles(config, 16) == (is_folded ? 2 * 4 : 4));
    config.rendering.drain_pixels_per_cycle = 1;
  }
  config.rendering.precision = BlendPrecision::kHalf;
  CHECK(drain_pipeline(config).lanes_of.empty());
}

}  // namespace
}  // namespace sgs::gscore
