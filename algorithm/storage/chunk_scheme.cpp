// Stored by chunks: few Gaussians that lie close together, found by a tree of their bounds.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "algorithm/files/input_error.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/storage_scheme.h"

namespace sgs {
namespace {

// Reading of the chunk table: downward for its shape, upward for its bounds.

class TableCheck {
 public:
  TableCheck(const ChunkTree& tree, std::uint32_t chunk_gaussians, const ActivatedCloud& decoded,
             const std::string& source)
      : tree_(tree), most_(chunk_gaussians), decoded_(decoded), source_(source) {}

  // Every node is the child of one before it, every slot in one chunk. Returns the levels of nodes.
  std::uint32_t check_shape() {
    const std::size_t slots = decoded_.size();
    level_.assign(tree_.nodes.size(), 0);
    in_chunk_.assign(slots, 0);
    std::uint32_t depth = 0;
    std::uint64_t chunks = 0, held = 0;
    for (std::size_t at = 0; at < tree_.nodes.size(); ++at) {
      const ChunkNode& node = tree_.nodes[at];
      if (at > 0 && level_[at] == 0) refuse(at, "no parent before it, expected one");
      level_[at] = at == 0 ? 1 : level_[at];
      depth = std::max(depth, level_[at]);
      if (node.children < 1 || node.children > kChunkNodeWidth) {
        refuse(at,
               fmt::format("got {} children, expected 1 to {}", node.children, kChunkNodeWidth));
      }
      for_children(at, [&](int c, std::uint64_t first) {
        if (node.count[c] == 0) {
          take_node(at, first);
        } else {
          take_chunk(at, first, node.count[c]);
          ++chunks;
          held += node.count[c];
        }
      });
    }
    if (chunks != tree_.chunk_count || held != slots) {
      throw InputError(
          fmt::format("{}: chunk table: got {} Gaussians in {} chunks, expected {} in {}", source_,
                      held, chunks, slots, tree_.chunk_count));
    }
    return depth;
  }

  // A child's bound holds all Gaussians below it. After check_shape().
  void check_bounds() const {
    std::vector<ChunkBound> of_slot(decoded_.size());
    tbb::parallel_for(std::size_t{0}, of_slot.size(), [&](std::size_t slot) {
      of_slot[slot] = gaussian_bound(decoded_.gaussians[slot]);
    });
    std::vector<ChunkBound> below(tree_.nodes.size());
    for (std::size_t at = tree_.nodes.size(); at-- > 0;) {
      const ChunkNode& node = tree_.nodes[at];
      for_children(at, [&](int c, std::uint64_t first) {
        ChunkBound child = node.count[c] == 0 ? below[first] : of_slot[first];
        for (std::uint64_t s = first + 1; s < first + node.count[c]; ++s) {
          child = merged(child, of_slot[s]);
        }
        if (!holds(child_bound(node, c), child)) {
          refuse(at, fmt::format("child {}: its bound leaves out a Gaussian below it", c));
        }
        below[at] = c == 0 ? child : merged(below[at], child);
      });
    }
  }

 private:
  // Calls visit(child, first slot of the chunk or node).
  template <class Visit>
  void for_children(std::size_t at, Visit&& visit) const {
    const ChunkNode& node = tree_.nodes[at];
    std::uint64_t slot = node.first_slot, inner = node.first_node;
    for (int c = 0; c < node.children; ++c) {
      visit(c, node.count[c] == 0 ? inner : slot);
      slot += node.count[c];
      inner += node.count[c] == 0 ? 1 : 0;
    }
  }

  void take_node(std::size_t parent, std::uint64_t node) {
    if (node <= parent || node >= tree_.nodes.size() || level_[node] != 0) {
      refuse(parent, fmt::format("got node {} as a child, expected one of {} to {} that has no "
                                 "parent yet",
                                 node, parent + 1, tree_.nodes.size() - 1));
    }
    level_[node] = level_[parent] + 1;
  }

  void take_chunk(std::size_t node, std::uint64_t first, std::uint32_t count) {
    if (count > most_ || first + count > in_chunk_.size()) {
      refuse(node,
             fmt::format("got a chunk of {} slots from {}, expected at most {}, none beyond {}",
                         count, first, most_, in_chunk_.size()));
    }
    for (std::uint64_t slot = first; slot < first + count; ++slot) {
      if (in_chunk_[slot] != 0) refuse(node, fmt::format("slot {} is in another chunk too", slot));
      in_chunk_[slot] = 1;
    }
  }

  static bool holds(const ChunkBound& outer, const ChunkBound& inner) {
    bool holds = outer.scale_max >= inner.scale_max;
    for (int k = 0; k < 3; ++k) {
      holds = holds && outer.low[k] <= inner.low[k] && outer.high[k] >= inner.high[k] &&
              outer.extent[k] >= inner.extent[k];
    }
    return holds;
  }

  [[noreturn]] void refuse(std::size_t node, const std::string& what) const {
    throw InputError(fmt::format("{}: chunk table: node {}: {}", source_, node, what));
  }

  const ChunkTree& tree_;
  const std::uint32_t most_;
  const ActivatedCloud& decoded_;
  const std::string& source_;
  std::vector<std::uint32_t> level_;  // [node] from 1; 0: no parent yet
  std::vector<char> in_chunk_;        // [slot]
};

// The table of an image, with nothing in it believed. decoded: the Gaussians by slot. source: what
// errors name. Throws InputError for a table that no builder could have made: every node and slot
// is reached once, and every child's bound holds the Gaussians below it, so that exact order misses
// none.
ChunkTree read_chunk_table(const MemoryImage& image, std::uint32_t chunk_gaussians,
                           const ActivatedCloud& decoded, const std::string& source) {
  const ChunkTableLayout& layout = image.layout.chunk_table();
  ChunkTree tree;
  tree.chunk_count = layout.chunk_count;
  tree.nodes.resize(layout.nodes.count);
  if (layout.nodes.count > 0) {
    std::memcpy(tree.nodes.data(), image.at(layout.nodes.base),
                tree.nodes.size() * sizeof(ChunkNode));
  }
  TableCheck check(tree, chunk_gaussians, decoded, source);
  tree.depth = check.check_shape();
  check.check_bounds();
  return tree;
}

constexpr std::uint32_t kMostGaussians = 65535;  // largest chunk

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
    return {{"chunks", "", "Stored by chunks: their number.", *blocks(table)}};
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
