// Stored by file: the order that the scene came in, for machines that read all of it and find what
// they need by themselves.
#include "algorithm/storage/build_memory_image.h"
#include "algorithm/storage/schemes.h"
#include "algorithm/storage/storage_scheme.h"

namespace sgs {
namespace {

class FileScheme : public StorageScheme {
 public:
  const char* name() const override { return "file"; }

  Arrangement<StoredTable> arrange(const ActivatedCloud& decoded,
                                   const StorageConfig& config) const override {
    return {NoTable{}, stored_gaussians(decoded, stored_of(config))};
  }
  MemoryImage image_of(const EncodedCloud& encoded, const StoredTable& table) const override {
    return build_memory_image(encoded, std::get<NoTable>(table));
  }
  StoredTable restore(const PackedScene&, const ActivatedCloud&,
                      const std::string&) const override {
    return NoTable{};
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

MemoryImage build_memory_image(const EncodedCloud& scene, NoTable) {
  return store_gaussians(scene, lay_out_file(scene.format, count_of(scene.decoded.gaussians)));
}

const StorageScheme& file_scheme() {
  static const FileScheme scheme;
  return scheme;
}

}  // namespace sgs
