// Passes, then lines, then entries, each as many as fit.
#include "modules/gscore/list_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "algorithm/files/input_error.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/sorting/bitonic_cost.h"

namespace sgs::gscore {
namespace {

// A list on chip is so long where that leaves a line for so few tiles, and else the next
// (README.md).
struct ListLength {
  std::uint32_t entries, tiles_of_line;
};
constexpr std::array<ListLength, 3> kLengths = {{{1024, 2}, {768, 4}, {512, 8}}};
// With a line for more tiles than that a pass takes fewer tiles.
constexpr std::uint32_t kMostTilesOfLine = kLengths.back().tiles_of_line;
constexpr std::uint32_t kMostEntries = 8192;  // entries of the longest list on chip

// The most in [least, most] that fits, in steps; 0 if not even `least` does.
std::uint32_t most_that_fits(std::uint32_t least, std::uint32_t most, std::uint32_t step,
                             const std::function<bool(std::uint32_t)>& fits) {
  if (!fits(least)) return 0;
  std::uint32_t low = 0, high = (most - least) / step;
  while (low < high) {
    const std::uint32_t middle = (low + high + 1) / 2;
    if (fits(least + middle * step)) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return least + low * step;
}

bool fits(const GscoreConfig& config) {
  return config.sram.buffer_bytes == 0 ||
         sram_bytes(sram_uses(config), kBuffer) <= config.sram.buffer_bytes;
}

}  // namespace

bool lists_open(const GscoreConfig& config) {
  return config.lists.tiles == 0 || config.lists.lines == 0 || config.sorting.list_entries == 0;
}

void choose_list_memory(GscoreConfig& config, std::uint32_t tiles,
                        std::vector<AutoChoice>& chosen) {
  const bool open_tiles = config.lists.tiles == 0, open_lines = config.lists.lines == 0,
             open_entries = config.sorting.list_entries == 0;
  if (!lists_open(config)) return;
  const auto lines_beside = [&](std::uint32_t entries, std::uint32_t of_pass) {
    if (open_entries) config.sorting.list_entries = std::max(entries, config.sorting.chunk_entries);
    config.lists.tiles = of_pass;
    if (!open_lines) return fits(config) ? config.lists.lines : 0;
    return most_that_fits(1, of_pass, 1, [&](std::uint32_t lines) {
      config.lists.lines = lines;
      return fits(config);
    });
  };
  const auto lines_of = [&](std::uint32_t of_pass) {
    std::uint32_t lines = 0;
    for (const ListLength& length : kLengths) {
      lines = lines_beside(length.entries, of_pass);
      if (!open_entries || lines >= cycles_for(of_pass, length.tiles_of_line)) break;
    }
    return lines;
  };
  if (open_tiles && lines_of(1) == 0) return;  // who refuses it shows the sum
  std::uint32_t of_pass = open_tiles ? tiles : config.lists.tiles, lines = lines_of(of_pass);
  const auto few = [&] { return of_pass > 1 && lines < cycles_for(of_pass, kMostTilesOfLine); };
  for (std::uint32_t passes = 2; open_tiles && few(); ++passes) {
    of_pass = static_cast<std::uint32_t>(cycles_for(tiles, passes));
    lines = lines_of(of_pass);
  }
  if (lines == 0) return;
  config.lists.lines = lines;
  if (open_entries && config.sram.buffer_bytes != 0) {
    config.sorting.list_entries = most_that_fits(config.sorting.list_entries, kMostEntries,
                                                 kNetworkWidth, [&](std::uint32_t entries) {
                                                   config.sorting.list_entries = entries;
                                                   return fits(config);
                                                 });
  }
  constexpr ChoiceKind kKind = ChoiceKind::kDecided;
  const std::string of = fmt::format("of {} tiles of the largest frame", tiles);
  if (open_tiles) {
    chosen.push_back(
        {kKind, "lists.tiles", static_cast<double>(of_pass),
         fmt::format("{}, in as few passes as leave a line for {} tiles", of, kMostTilesOfLine)});
  }
  if (open_lines) {
    chosen.push_back({kKind, "lists.lines", static_cast<double>(lines),
                      fmt::format("as many as fit, one a tile at most: {} tiles a pass", of_pass)});
  }
  if (open_entries) {
    chosen.push_back({kKind, "sorting.list_entries",
                      static_cast<double>(config.sorting.list_entries),
                      "lists on chip as long as what is left allows"});
  }
}

}  // namespace sgs::gscore
