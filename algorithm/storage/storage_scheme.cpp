// The storage orders of this project, a line each.
#include "algorithm/storage/storage_scheme.h"

#include <array>

#include "algorithm/storage/schemes.h"

namespace sgs {

const StorageScheme& scheme_of(StorageOrder order) {
  static const std::array<const StorageScheme*, std::variant_size_v<TableLayout>> schemes = {
      &voxel_scheme(), &chunk_scheme(), &file_scheme()};  // [StorageOrder]
  return *schemes.at(static_cast<std::size_t>(order));
}

}  // namespace sgs
