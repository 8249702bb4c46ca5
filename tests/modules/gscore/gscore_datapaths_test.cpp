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
  CHECK(drain_pipeline(config).interval_cycles() == 1);
}

}  // namespace
}  // namespace sgs::gscore
