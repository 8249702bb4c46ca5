// The scenes that scripts/bench.sh hands to every benchmark.
#pragma once

#include <string>
#include <vector>

#include "algorithm/dataset/view_cameras.h"
#include "testbench/builtin/open_scene.h"

namespace sgs {

// Loads `spec`: a built-in scene, or a .ply whose cameras lie beside it under the same name with
// the ending .json. Throws InputError.
inline Scene load_bench_scene(const std::string& spec) {
  Scene scene = open_scene(spec);
  if (scene.cameras.empty()) {
    scene.cameras = read_view_cameras(spec.substr(0, spec.rfind('.')) + ".json").cameras;
  }
  return scene;
}

}  // namespace sgs
