// The final order of exact order: by depth, then slot. No two keys of a group have the same slot.
#pragma once

#include "modules/streaminggs/messages.h"

namespace sgs {

struct NearerKey {
  bool operator()(const FineCandidate& a, const FineCandidate& b) const {
    return a.depth < b.depth || (a.depth == b.depth && a.slot < b.slot);
  }
};

}  // namespace sgs
