// A real scene under test, read from ../shared; the test is skipped where it is missing.
#pragma once

#include <string>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/against_double.h"
#include "tests/algorithm/render/against_golden.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {

inline void check_scene_against_double(const std::string& name) {
  const auto cameras = read_view_cameras(shared_path("cameras/" + name + ".json")).cameras;
  const GaussianCloud cloud = read_ply(shared_scene(name)).cloud;
  for (const Camera& camera : cameras) check_against_double(name, camera, cloud);
}

inline void check_scene_against_golden(const std::string& name) {
  const auto cameras = read_view_cameras(shared_path("cameras/" + name + ".json")).cameras;
  const std::string golden = shared_path("golden/" + name + ".csv");
  const ActivatedCloud cloud = activate(read_ply(shared_scene(name)).cloud);
  for (const Camera& camera : cameras) check_against_golden(golden, camera, cloud);
}

}  // namespace sgs::test
