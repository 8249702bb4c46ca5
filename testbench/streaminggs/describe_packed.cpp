// Lines about a packed scene.
#include "testbench/streaminggs/describe_packed.h"

#include <fmt/format.h>

#include <string>

#include "testbench/streaminggs/numbers.h"

namespace sgs {
namespace {

void line(const std::string& name, const std::string& value) {
  fmt::print("{:<26}{}\n", name, value);
}

}  // namespace

void print_packed(const PackedFacts& facts, const StorageConfig& storage, const SceneLayout& layout,
                  const std::string& readers) {
  const SecondHalfFormat& format = layout.second_half;
  line("scene", facts.name);
  line("gaussians stored",
       fmt::format("{} of {}", grouped(layout.gaussian_count()), grouped(facts.gaussians)));
  line("dropped invalid", fmt::format("{} Gaussians", grouped(facts.dropped_invalid)));
  line("sh degree", std::to_string(format.sh_degree));
  if (storage.order == StorageOrder::kChunks) {
    line("storage order",
         fmt::format("by chunks, for machine {}: {} of at most {} Gaussians", readers,
                     grouped(layout.chunk_table().chunk_count), storage.chunk_gaussians));
  } else {
    line("storage order", fmt::format("by voxels, for machine {}: {} of {} world units", readers,
                                      grouped(layout.voxel_table().voxels.count),
                                      rounded(layout.voxel_table().frame.voxel_size)));
  }
  line("second halves",
       fmt::format("{}, {} B each", kEncodingNames[static_cast<std::size_t>(format.encoding)],
                   format.bytes()));
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    line(fmt::format("codebook {}", kCodebookNames[id]),
         fmt::format("{} entries x {} words, {} B", grouped(format.entries[id]),
                     codebook_words(codebook, format.sh_degree),
                     grouped(format.entries[id] * format.entry_bytes(codebook))));
  }
  for (const Region& region : layout.regions) {
    line("region " + region.name, fmt::format("{} B", grouped(region.bytes)));
  }
  line("image", fmt::format("{} B", grouped(layout.stored_bytes)));
}

}  // namespace sgs
