// Stored by file: for machines that read all of a scene and find what they need by themselves. In
// the order that the scene came in, or neighbours in space side by side.
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {
namespace {

// Gaussians in a leaf of the tree of bounds that gives the spatial sequence: so many first halves
// lie together in a row of memory (storage_scheme.h).
constexpr std::uint32_t kNeighbours = 16;

class FileScheme : public StorageScheme {
 public:
  const char* name() const override { return "file"; }
  bool has_sequence() const override { return true; }

  Arrangement<StoredTable> arrange(const ActivatedCloud& decoded,
                                   const StorageConfig& config) const override {
    const Stored stored = stored_of(config);
    if (config.sequence == FileSequence::kFile) {
      return {NoTable{}, stored_gaussians(decoded, stored)};
    }
    return {NoTable{}, arrange_by_chunks(decoded, kNeighbours, stored).storage_order};
  }
  MemoryImage image_of(const EncodedCloud& encoded, const StoredTable& table) const override {
    return build_memory_image(encoded, std::get<NoTable>(table));
  }
  StoredTable restore(const PackedScene&, const ActivatedCloud&,
                      const std::string&) const override {
    return NoTable{};
  }

  TableLayout empty_table() const override { return NoTableLayout{}; }
  void visit(TableFields& fields, StorageConfig& storage, TableLayout&) const override {
    auto sequence = static_cast<std::uint32_t>(storage.sequence);
    fields("sequence", sequence, 0, static_cast<double>(FileSequence::kSpatial));
    storage.sequence = static_cast<FileSequence>(sequence);
  }
  SceneLayout lay_out(const SecondHalfFormat& format, std::uint32_t gaussians, const StorageConfig&,
                      const TableLayout&) const override {
    return lay_out_file(format, gaussians);
  }

  std::string in_words(const StorageConfig& config) const override {
    return config.sequence == FileSequence::kFile ? "in the file's order" : "neighbours together";
  }
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
