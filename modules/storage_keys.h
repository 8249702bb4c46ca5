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
  if (scheme_of(c.order).has_sequence()) {
    v("sequence", c.sequence,
      names<FileSequence>({{"file", FileSequence::kFile}, {"spatial", FileSequence::kSpatial}}),
      "of Gaussians: as in the scene's file, or neighbours in space side by side");
  }
  visit_every_order(v, c);
}

}  // namespace sgs
