// Data sheet of sampled rays: their memories, lanes and comparators.
#include <algorithm>

#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/vsu/sampled_rays.h"

namespace sgs {
namespace {

// Bytes kept of a ray that has begun: the way from sample to sample, the first and the last; of a
// cell on its way to the tables: its number and its distance from the eye's.
constexpr std::uint32_t kBegunRayBytes = 20, kCellBytes = 8;

// Operations beside the lanes: a sample's cell is compared with the ray's last (two words); of a
// new one the distance from the eye's cell takes three differences and two sums, and is compared
// with the end of the window.
constexpr std::uint32_t kOfSample = 2, kOfCell = 6;
// A voxel is compared with the window's ends, and with the nearest and the farthest in it.
constexpr std::uint32_t kOfMet = 2, kOfEntered = 2;
// Entries of a line of the renaming table with the number, two words each.
constexpr std::uint32_t kOfNumber = 2 * kRenamedInLine;

}  // namespace

SramUses SampledRays::sram_uses(const PaperVsuConfig& config, const BuiltFor& built_for) {
  SramUses uses = TableCache<RenamingLine>::sram_uses("renaming table", "renaming table tags",
                                                      kSharedSram, config.renaming_bytes);
  const std::uint32_t samples = config.samples_per_cycle;
  uses.push_back(sram_use("begun rays", kSharedSram,
                          {{config.rays_in_flight, "rays"}, {kBegunRayBytes, "B"}},
                          {8 * kBegunRayBytes}, kOneOfEach));
  uses.push_back(sram_use("sampled cells", kSharedSram, {{samples, "cells"}, {kCellBytes, "B"}},
                          {8 * kCellBytes, SramPorts::kReadAndWrite, samples}, {1, samples}));
  uses.push_back(sram_use("ordering table", kSharedSram, {{config.table_bytes, "B"}},
                          {8 * kTableWordBytes}, kOneOfEach));
  const std::uint64_t names = names_bytes(config);
  uses.push_back(sram_use(
      "renamed voxels", kSharedSram, {{names / kNameBytes, "slots"}, {kNameBytes, "B"}},
      {8 * static_cast<std::uint32_t>(std::min<std::uint64_t>(kNamesWord, names))}, kOneOfEach));
  uses.push_back(sram_use("ready voxels", kSharedSram,
                          {{ready_words(config), "words"}, {kReadyWord, "B"}}, {8 * kReadyWord},
                          kOneOfEach));
  const std::uint32_t line = AdjacencyCache::line_bytes(config);
  uses.push_back(sram_use("adjacency lines", kSharedSram,
                          {{config.adjacency_lines, "lines"}, {line, "B"}}, {8 * line},
                          kOneOfEach));
  uses.push_back(sram_use("adjacency tags", kSharedSram,
                          {{config.adjacency_lines, "lines"}, {kAdjacencyTagBytes, "B"}},
                          {8 * kAdjacencyTagBytes}, kOneOfEach));
  uses.push_back(unanswered_writes("adjacency writes", kSharedSram, built_for.memory_port, line));
  return uses;
}

void SampledRays::publish(DataSheet& sheet) const {
  sheet.datapath(begins_, counts_.rays);
  sheet.datapath(samples_, counts_.samples);
  renaming_.publish_accesses(sheet, "renaming table", "renaming table tags");
  sheet.accesses("begun rays", counts_.beats, counts_.rays);
  sheet.accesses("sampled cells", counts_.cells, counts_.cells);
  sheet.accesses("ordering table", counts_.accesses.reads, counts_.accesses.writes);
  sheet.accesses("renamed voxels", counts_.accesses.names_read,
                 counts_.accesses.names_written + counts_.names_cleared);
  sheet.accesses("ready voxels", counts_.accesses.ready_read,
                 counts_.accesses.ready_written + counts_.ready_cleared);
  // A line that goes out is read, one that comes back is written.
  const std::uint64_t out = adjacency_.lines_out(), back = adjacency_.lines_back();
  sheet.accesses("adjacency lines", counts_.lines_read + out, counts_.lines_written + back);
  sheet.accesses("adjacency tags", counts_.lines_read,
                 counts_.lines_written + back + counts_.tags_freed);
  sheet.counter("samples", "samples", "of rays, in the box of all voxels or a hair beside it",
                counts_.samples);
  sheet.counter("cells_looked_up", "cells", "of samples, each of a ray once, in the renaming table",
                counts_.cells);
  sheet.counter("renaming_misses", "lines", "of the renaming table read from DRAM",
                renaming_.misses());
  sheet.counter("adjacency_lines_out", "lines", "of edges written to DRAM", out);
  sheet.counter("adjacency_lines_back", "lines", "of edges read from DRAM", back);
  const std::uint32_t of_sampler = kOfSample + kOfCell,
                      destinations = config_.adjacency_destinations;
  sheet.part("vsu", "comparator",
             config_.samples_per_cycle * static_cast<double>(of_sampler) + kOfMet + kOfEntered +
                 kOfNumber + kCacheWays + destinations + 2,
             1);
  sheet.operations(
      "vsu", "comparator",
      static_cast<double>(kOfSample * counts_.samples + kOfCell * counts_.cells +
                          kOfMet * counts_.met + kOfEntered * counts_.entered +
                          (kOfNumber + kCacheWays) * renaming_.lookups() + counts_.accesses.reads +
                          (destinations + 1) * counts_.lines_read));
}

Remedy SampledRays::remedy() const {
  if (counts_.rays * begins_.interval_cycles() > counts_.beats) return "vsu.ray_lanes";
  if (counts_.beats > counts_.cells) return "vsu.samples_per_cycle";
  return "vsu.sample_step_voxels";
}

Remedy SampledRays::remedy_of_reads() const {
  if (adjacency_.lines_back() > renaming_.misses()) return "vsu.adjacency_lines";
  return "vsu.renaming_bytes";
}

}  // namespace sgs
