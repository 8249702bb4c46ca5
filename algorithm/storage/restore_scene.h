// The inverse of store_scene.h: from a memory image the scene that golden renderers need.
#pragma once

#include <string>

#include "algorithm/storage/image_file.h"
#include "algorithm/storage/stored_scene.h"

namespace sgs {

// Golden renderers give the same bits on it as on the scene that was stored. source: what errors
// name. Throws InputError when tables or records say what no builder could have written.
StoredScene restore_scene(PackedScene packed, const std::string& source);

}  // namespace sgs
