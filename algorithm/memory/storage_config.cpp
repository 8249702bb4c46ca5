// What follows from a choice of storage before the scene is known.
#include "algorithm/memory/storage_config.h"

namespace sgs {

SecondHalfFormat StorageConfig::widest_format(int sh_degree) const {
  SecondHalfFormat format{encoding, sh_degree, {}};
  if (!format.quantised()) return format;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const auto codebook = static_cast<Codebook>(id);
    format.entries[id] = codebook_words(codebook, sh_degree) > 0 ? vq.entries(codebook) : 0;
  }
  return format;
}

}  // namespace sgs
