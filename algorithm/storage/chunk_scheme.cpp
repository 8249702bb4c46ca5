// Stored by chunks: few Gaussians that lie close together, found by a tree of their bounds.
#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "algorithm/storage/build_memory_image.h"
#include "algorithm/storage/schemes.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_tables.h"

namespace sgs {
namespace {

constexpr std::uint32_t kMostGaussians = 65535;  // of a chunk

class ChunkScheme : public StorageScheme {
 public:
  const char* name() const override { return "chunks"; }

  std::vector<StorageSize> sizes() const override {
    return {{"chunk_gaussians", &StorageConfig::chunk_gaussians, kMostGaussians,
             "most Gaussians in a chunk; 0: as many as lie together in a DRAM row"}};
  }

  using StorageScheme::choose;
  std::vector<StorageChoice> choose(StorageConfig& config, std::uint32_t run_bytes) const override {
    if (config.chunk_gaussians != 0) return {};
    const Choice<std::uint32_t> chunk = choose_chunk_gaussians(run_bytes);
    config.chunk_gaussians = chunk.value;
    return {{"chunk_gaussians", static_cast<double>(chunk.value), chunk.why}};
  }

  void check(const StorageConfig& config) const override {
    if (config.chunk_gaussians > 0) return;
    throw InputError("chunk_gaussians: got 0, expected 1 or more");
  }

  Arrangement<StoredTable> arrange(const ActivatedCloud& decoded,
                                   const StorageConfig& config) const override {
    auto [tree, storage_order] =
        arrange_by_chunks(decoded, config.chunk_gaussians, stored_of(config));
    return {std::move(tree), std::move(storage_order)};
  }
  MemoryImage image_of(const EncodedCloud& encoded, const StoredTable& table) const override {
    return build_memory_image(encoded, std::get<ChunkTree>(table));
  }
  StoredTable restore(const PackedScene& packed, const ActivatedCloud& decoded,
                      const std::string& source) const override {
    return read_chunk_table(packed.image, packed.storage.chunk_gaussians, decoded, source);
  }

  TableLayout empty_table() const override { return ChunkTableLayout{}; }

  void visit(TableFields& fields, StorageConfig& storage, TableLayout& layout) const override {
    auto& table = std::get<ChunkTableLayout>(layout);
    fields("chunk_gaussians", storage.chunk_gaussians, 1, kMostGaussians);
    fields.count("chunk nodes", table.nodes.count);
    fields.count("chunks", table.chunk_count);
  }

  SceneLayout lay_out(const SecondHalfFormat& format, std::uint32_t gaussians, const StorageConfig&,
                      const TableLayout& layout) const override {
    const auto& table = std::get<ChunkTableLayout>(layout);
    return lay_out_chunks(format, gaussians, static_cast<std::uint32_t>(table.nodes.count),
                          table.chunk_count);
  }

  std::string in_words(const StorageConfig& config) const override {
    return fmt::format("chunks of {}", config.chunk_gaussians);
  }
  std::optional<std::uint64_t> blocks(const TableLayout& table) const override {
    return std::get<ChunkTableLayout>(table).chunk_count;
  }
  std::string size_in_words(const StorageConfig& config) const override {
    return fmt::format("at most {} Gaussians", config.chunk_gaussians);
  }
  std::vector<StorageFact> facts(const TableLayout& table) const override {
    return {{"chunks", *blocks(table)}};
  }
};

}  // namespace

MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree) {
  MemoryImage image =
      store_gaussians(scene, lay_out_chunks(scene.format, count_of(scene.decoded.gaussians),
                                            count_of(tree.nodes), tree.chunk_count));
  store_table(tree.nodes, image.layout.chunk_table().nodes.base, image);
  return image;
}

const StorageScheme& chunk_scheme() {
  static const ChunkScheme scheme;
  return scheme;
}

}  // namespace sgs
