// On-chip memory of the tile-centric machine, and combinations that cannot be built.
#include "modules/gscore/gscore_config.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/files/input_error.h"
#include "modules/gscore/ccu/ccu.h"
#include "modules/gscore/culling/chunk_culler.h"
#include "modules/gscore/gscore_machine.h"
#include "modules/gscore/lists/tile_lister.h"
#include "modules/gscore/rendering/render_core.h"
#include "modules/gscore/sorting/tile_sorter.h"

namespace sgs::gscore {
namespace {

// Calls visit(split) for every encoding and degree of the scenes that it takes.
template <class Visit>
void for_each_split(StorageOrder order, const Visit& visit) {
  for (const auto encoding : {SecondHalfEncoding::kRaw, SecondHalfEncoding::kHalf}) {
    for (int degree = 0; degree <= kMostDegree; ++degree) {
      visit(split_of(order, {encoding, degree, {}}));
    }
  }
}

}  // namespace

std::uint32_t GscoreConfig::first_half_bytes() const {
  std::uint32_t most = 0;
  for_each_split(storage_order(),
                 [&](const RecordSplit& split) { most = std::max(most, split.first_bytes()); });
  return most;
}

std::uint32_t GscoreConfig::carried_words() const {
  std::uint32_t most = 0;
  for_each_split(storage_order(),
                 [&](const RecordSplit& split) { most = std::max(most, split.carried_words); });
  return most;
}

TileOrderConfig GscoreConfig::order() const {
  TileOrderConfig out;
  out.rules = tiles.rules();
  out.features = tiles.features;
  out.keys = tiles.keys;
  out.precision = rendering.precision;
  out.chunk_entries = sorting.chunk_entries;
  return out;
}

SramUses sram_uses(const GscoreConfig& c) {
  SramUses uses;
  if (c.culls_chunks()) add(uses, ChunkCuller::sram_uses(c));
  add(uses, Ccu::sram_uses(c), c.ccus);
  add(uses, TileLister::sram_uses(c));
  add(uses, TileSorter::sram_uses(c), c.cores);
  add(uses, RenderCore::sram_uses(c), c.cores);
  add(uses, queue_uses(c));
  return uses;
}

void check(const GscoreConfig& c) {
  if (c.tiles.subtiles_across == 3) {
    throw InputError("tiles.subtiles_across: got 3, expected 1, 2 or 4");
  }
  if ((c.lists.line_bytes & (c.lists.line_bytes - 1)) != 0) {
    throw InputError(
        fmt::format("lists.line_bytes: got {}, expected a power of two", c.lists.line_bytes));
  }
  if (c.sorting.list_entries != 0 && c.sorting.list_entries < c.sorting.chunk_entries) {
    throw InputError(fmt::format("sorting.list_entries: got {}, expected at least a chunk: {}",
                                 c.sorting.list_entries, c.sorting.chunk_entries));
  }
}

}  // namespace sgs::gscore
