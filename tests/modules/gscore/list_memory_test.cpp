// How the on-chip memory is shared between tables, lines and lists.
#include "modules/gscore/list_memory.h"

#include <catch2/catch.hpp>
#include <vector>

namespace sgs::gscore {
namespace {

GscoreConfig chosen_for(std::uint32_t tiles, GscoreConfig config = {}) {
  std::vector<AutoChoice> chosen;
  choose_list_memory(config, tiles, chosen);
  return config;
}

std::uint64_t needed(const GscoreConfig& config) { return sram_bytes(sram_uses(config), kBuffer); }

TEST_CASE("list memory: what is chosen fits, and hardly more would") {
  for (const std::uint32_t tiles : {1U, 40U, 920U, 2170U, 3600U, 8160U, 14400U, 100000U}) {
    INFO(tiles << " tiles");
    const GscoreConfig config = chosen_for(tiles);
    CHECK(needed(config) <= config.sram.buffer_bytes);
    CHECK(config.lists.tiles <= tiles);
    CHECK(config.lists.lines <= config.lists.tiles);
    CHECK(8 * config.lists.lines >= config.lists.tiles);
    CHECK(config.sorting.list_entries >= 512);
    if (config.lists.lines < config.lists.tiles) {
      GscoreConfig more = config;
      more.lists.lines += 64;
      CHECK(needed(more) > more.sram.buffer_bytes);
    } else if (config.sorting.list_entries < 8192) {
      GscoreConfig longer = config;
      longer.sorting.list_entries += 16;
      CHECK(needed(longer) > longer.sram.buffer_bytes);
    }
  }
}

TEST_CASE("list memory: a pass if that leaves tiles their lines, several if not") {
  CHECK(chosen_for(920).lists.tiles == 920);
  CHECK(chosen_for(920).lists.lines == 920);
  CHECK(chosen_for(920).sorting.list_entries > 1024);
  CHECK(chosen_for(8160).lists.tiles == 8160);
  CHECK(chosen_for(14400).lists.tiles == 7200);
}

TEST_CASE("list memory: lists are the longest that leave tiles their lines") {
  // With keys of 32 bits lines hold fewer entries and lists on chip take more.
  GscoreConfig preset;
  preset.memory_port.max_outstanding = 48;
  GscoreConfig wide = preset;
  wide.tiles.keys = NumberFormat::kSingle;
  struct Case {
    GscoreConfig config;
    std::uint32_t tiles, least_entries, tiles_of_line;
  };
  for (const Case& of :
       {Case{preset, 2500, 1024, 2}, Case{preset, 3600, 1024, 2}, Case{wide, 2170, 1024, 2},
        Case{wide, 2500, 768, 4}, Case{wide, 3600, 768, 4}, Case{wide, 5400, 512, 8}}) {
    INFO(of.tiles << " tiles, keys of " << of.config.entries().key_bytes() << " B");
    const GscoreConfig config = chosen_for(of.tiles, of.config);
    CHECK(config.lists.tiles == of.tiles);
    CHECK(config.sorting.list_entries >= of.least_entries);
    CHECK(config.sorting.list_entries < of.least_entries + 256);
    CHECK(of.tiles_of_line * config.lists.lines >= of.tiles);
  }
}

TEST_CASE("list memory: what is given stays") {
  GscoreConfig given;
  given.lists.tiles = 5;
  given.sorting.list_entries = 256;
  const GscoreConfig config = chosen_for(1000, given);
  CHECK(config.lists.tiles == 5);
  CHECK(config.lists.lines == 5);
  CHECK(config.sorting.list_entries == 256);
  given.lists.lines = 3;
  CHECK(chosen_for(1000, given).lists.lines == 3);
}

TEST_CASE("list memory: without a limit a pass and a line a tile") {
  GscoreConfig open;
  open.sram.buffer_bytes = 0;
  const GscoreConfig config = chosen_for(20000, open);
  CHECK(config.lists.tiles == 20000);
  CHECK(config.lists.lines == 20000);
  CHECK(config.sorting.list_entries == 1024);
}

TEST_CASE("list memory: what cannot fit is left for the sum to show") {
  GscoreConfig small;
  small.sram.buffer_bytes = 1000;
  CHECK(needed(chosen_for(920, small)) > small.sram.buffer_bytes);
  GscoreConfig many;
  many.lists.lines = 8192;
  CHECK(needed(chosen_for(12, many)) > many.sram.buffer_bytes);
}

}  // namespace
}  // namespace sgs::gscore
