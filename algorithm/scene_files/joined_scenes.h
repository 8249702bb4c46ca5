// Scenes that stand in several parts of a file.
#pragma once

#include <string>

#include "algorithm/scene/scene_contents.h"

namespace sgs {

// Adds `more` behind what `all` holds. origin: of `more`, for messages. Throws InputError where
// they differ in degree.
void append_scene(const std::string& origin, SceneContents&& more, SceneContents& all);

}  // namespace sgs
