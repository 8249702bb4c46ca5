// Storage of a scene, as keys of the configuration: those of its storage order, and those of every
// order.
#pragma once

#include <variant>

#include "algorithm/memory/storage_config.h"
#include "algorithm/storage/storage_scheme.h"
#include "modules/config/config_visitor.h"

namespace sgs {

// The keys of other storage orders are unknown.
inline void visit(ConfigVisitor& v, StorageConfig& c) {
  for (const StorageSize& size : scheme_of(c.order).sizes()) {
    std::visit([&](auto value) { v(size.key, c.*value, in_range(0, size.most), size.meaning); },
               size.value);
  }
  if (scheme_of(c.order).has_voxel_rule()) {
    v("voxel_rule", c.voxel_rule,
      names<VoxelRule>({{"extent", VoxelRule::kExtent},
                        {"real", VoxelRule::kReal},
                        {"synthetic", VoxelRule::kSynthetic}}),
      "voxel_size 0: 0.4 for a scene below 10 units across, else 2; or 2, or 0.4, where the scene "
      "has the paper's unit of length");
  }
  if (scheme_of(c.order).has_sequence()) {
    v("sequence", c.sequence,
      names<FileSequence>({{"file", FileSequence::kFile}, {"spatial", FileSequence::kSpatial}}),
      "of Gaussians: as in the scene's file, or neighbours in space side by side");
  }
  visit_every_order(v, c);
}

}  // namespace sgs
