// A scene made ready for a machine: encoded and laid out as its storage says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/load_scene.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/stored_scene.h"
#include "testbench/streaminggs/run_config.h"

namespace sgs {

struct PreparedScene {
  std::string name;
  std::uint64_t dropped_invalid = 0;
  StoredScene stored;

  // What the reference picture is of: the scene as given, where it is at hand, in storage order.
  const ActivatedCloud& given() const {
    return stored.original ? *stored.original : stored.decoded;
  }
};

// Fill in what the configuration leaves to the scene; of a scene that is not stored yet, as far as
// that is known without its codebooks. Throw InputError.
void adapt(RunConfig& config, const Scene& scene);
void adapt(RunConfig& config, const PackedScene& packed);

// Both do so too. weighing: cameras that weigh the Gaussians where second halves are quantised;
// progress of that goes to stderr if it is a terminal. path: of the packed file. Both throw
// InputError.
PreparedScene prepare(Scene scene, RunConfig& config, const std::vector<Camera>& weighing);
PreparedScene prepare(PackedScene packed, const std::string& path, RunConfig& config);

}  // namespace sgs
