// A scene laid out in the modelled DRAM: its layout, and the bytes.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithm/memory/scene_layout.h"

namespace sgs {

struct MemoryImage {
  SceneLayout layout;            // of the scene alone
  std::vector<std::byte> bytes;  // [layout.stored_bytes] from address 0 on

  const std::byte* at(std::uint64_t address) const { return bytes.data() + address; }
};

}  // namespace sgs
