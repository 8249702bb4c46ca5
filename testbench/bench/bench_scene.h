// Scenes and times of benchmarks; scripts/bench.sh hands the scenes to all of them.
#pragma once

#include <algorithm>
#include <chrono>
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

// Wall time of work(), milliseconds.
template <class Work>
double time_ms(const Work& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  return took.count();
}

// The upper one of two middles; `times` must not be empty.
inline double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace sgs
