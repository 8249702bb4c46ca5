// Lines about a packed scene.
#include "testbench/streaminggs/describe_packed.h"

#include <fmt/format.h>

#include <string>

#include "algorithm/memory/image_file_fields.h"

namespace sgs {
namespace {

void line(const std::string& name, const std::string& value) {
  fmt::print("{:<26}{}\n", name, value);
}

}  // namespace

void print_packed(const PackedFacts& facts, const MemoryLayout& layout) {
  const SecondHalfFormat& format = layout.second_half;
  line("scene", facts.name);
  line("gaussians stored", fmt::format("{} of {}", layout.gaussian_count, facts.gaussians));
  line("dropped invalid", fmt::format("{} Gaussians", facts.dropped_invalid));
  line("sh degree", std::to_string(format.sh_degree));
  if (layout.storage_order == StorageOrder::kChunks) {
    line("storage order", fmt::format("by chunks, for ordering exact: {} of at most {} Gaussians",
                                      layout.chunk_count, facts.chunk_gaussians));
  } else {
    line("storage order", fmt::format("by voxels, for ordering paper: {} of {} world units",
                                      layout.voxel_count, layout.voxel_frame.voxel_size));
  }
  line("second halves",
       fmt::format("{}, {} B each", kEncodingNames[static_cast<std::size_t>(format.encoding)],
                   format.bytes()));
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    line(fmt::format("codebook {}", kCodebookNames[id]),
         fmt::format("{} entries x {} words, {} B", format.entries[id],
                     codebook_words(codebook, format.sh_degree),
                     format.entries[id] * format.entry_bytes(codebook)));
  }
  for (std::size_t region = 0; region < kFileRegions; ++region) {
    line(fmt::format("region {}", kRegionNames[region]),
         fmt::format("{} B", layout.regions[region].bytes));
  }
  line("image", fmt::format("{} B", layout[Region::kSpill].base));
}

}  // namespace sgs
