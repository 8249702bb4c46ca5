// Stored by file: the order that the scene came in, for machines that read all of it and find what
// they need by themselves. Slots are in the order that breaks ties of depth, so no index is kept.
#include <numeric>

#include "algorithm/storage/build_memory_image.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/schemes.h"
#include "algorithm/storage/storage_scheme.h"

namespace sgs {
namespace {

class FileScheme : public StorageScheme {
 public:
  const char* name() const override { return "file"; }

  void store(const EncodedCloud& encoded, StoredScene& out) const override {
    FileOrder order{stored_gaussians(encoded.decoded, stored_of(out.storage))};
    out.image = build_memory_image(encoded, order);
    out.table = std::move(order);
  }

  void restore(const PackedScene& packed, const std::string& source,
               StoredScene& out) const override {
    FileOrder order;
    order.storage_order.resize(packed.image.layout.gaussian_count());
    std::iota(order.storage_order.begin(), order.storage_order.end(), 0U);
    out.decoded = decode_image(packed.image, order.storage_order, source);
    out.table = std::move(order);
  }

  TableLayout empty_table() const override { return NoTableLayout{}; }
  void visit(TableFields&, StorageConfig&, TableLayout&) const override {}
  SceneLayout lay_out(const SecondHalfFormat& format, std::uint32_t gaussians, const StorageConfig&,
                      const TableLayout&) const override {
    return lay_out_file(format, gaussians);
  }

  std::string in_words(const StorageConfig&) const override { return "in the file's order"; }
};

}  // namespace

MemoryImage build_memory_image(const EncodedCloud& scene, const FileOrder& order) {
  return store_gaussians(scene, lay_out_file(scene.format, count_of(order.storage_order)),
                         order.storage_order);
}

const StorageScheme& file_scheme() {
  static const FileScheme scheme;
  return scheme;
}

}  // namespace sgs
