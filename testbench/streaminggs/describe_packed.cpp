// Lines about a packed scene.
#include "testbench/streaminggs/describe_packed.h"

#include <fmt/format.h>

#include <string>

#include "algorithm/storage/storage_scheme.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {
namespace {

// "by chunks, for machine exact: 375 of at most 16 Gaussians"
std::string order_line(const StorageConfig& storage, const SceneLayout& layout,
                       const std::string& readers) {
  const StorageScheme& scheme = scheme_of(storage.order);
  const auto blocks = scheme.blocks(layout.table);
  return fmt::format("by {}, for {}: {}", scheme.name(),
                     readers.empty() ? "no machine of this program" : "machine " + readers,
                     blocks
                         ? fmt::format("{} of {}", grouped(*blocks), scheme.size_in_words(storage))
                         : "no table");
}

}  // namespace

void print_packed(const PackedFacts& facts, const StorageConfig& storage, const SceneLayout& layout,
                  const std::string& readers) {
  const SecondHalfFormat& format = layout.second_half;
  print_fact("scene", facts.name);
  print_fact("gaussians stored",
             fmt::format("{} of {}", grouped(layout.gaussian_count()), grouped(facts.gaussians)));
  print_fact("dropped invalid", fmt::format("{} Gaussians", grouped(facts.dropped_invalid)));
  print_fact("sh degree", std::to_string(format.sh_degree));
  if (facts.sh_bands_left_out > 0) {
    print_fact("sh bands left out", fmt::format("{}: they change no colour by more than {:.3g}",
                                                facts.sh_bands_left_out, storage.sh_tolerance));
  }
  print_fact("storage order", order_line(storage, layout, readers));
  print_fact("second halves",
             fmt::format("{}, {} B each", kEncodingNames[static_cast<std::size_t>(format.encoding)],
                         layout.second_halves.record_bytes));
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    print_fact(fmt::format("codebook {}", kCodebookNames[id]),
               fmt::format("{} entries x {} words, {} B", grouped(format.entries[id]),
                           codebook_words(codebook, format.sh_degree),
                           grouped(format.entries[id] * format.entry_bytes(codebook))));
  }
  for (const Region& region : layout.regions) {
    print_fact("region " + region.name, fmt::format("{} B", grouped(region.bytes)));
  }
  print_fact("image", fmt::format("{} B", grouped(layout.stored_bytes)));
}

}  // namespace sgs
