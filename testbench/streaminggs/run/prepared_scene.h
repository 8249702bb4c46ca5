// A scene made ready for a machine: encoded and laid out as its storage says.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "algorithm/scene_files/load_scene.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/vq/quantise.h"
#include "testbench/streaminggs/run/codebook_cache.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {

struct PreparedScene {
  std::string name;
  std::uint64_t dropped_invalid = 0;
  StoredScene stored;
  std::vector<StorageChoice> choices = {};  // choices that were left to the scene
  std::uint64_t image_hash = 0;             // hash of the bytes loaded into the memory
  std::string axes = {};                    // see Scene

  // The scene that the reference picture shows: as given, where it is at hand, in storage order.
  const ActivatedCloud& given() const {
    return stored.original ? *stored.original : stored.decoded;
  }
};

// Fill in what the configuration leaves to the scene; of a scene that is not stored yet, as far as
// that is known without its codebooks; of a prepared one, whose storage is the configuration's.
// Throw InputError.
void adapt(RunConfig& config, const Scene& scene);
void adapt(RunConfig& config, const PackedScene& packed);
void adapt(RunConfig& config, const PreparedScene& scene);

// Stores a scene as a configuration says, which is not filled in. quantise: makes its codebooks,
// where the encoding has any. Throws InputError.
using Quantise = std::function<QuantisedCloud(const ActivatedCloud&, const VqConfig&)>;
PreparedScene store(std::string name, std::uint64_t dropped_invalid, ActivatedCloud cloud,
                    const RunConfig& config, const Quantise& quantise);

// path: of the packed file. Throws InputError.
PreparedScene restore(PackedScene packed, const std::string& path);

// Store, or restore, and fill in. weighing: cameras that weigh the Gaussians where second halves
// are quantised; progress of that goes to stderr if it is a terminal. Both throw InputError.
PreparedScene prepare(Scene scene, RunConfig& config, const std::vector<Camera>& weighing,
                      const CodebookCache& cache = {});
PreparedScene prepare(PackedScene packed, const std::string& path, RunConfig& config);

}  // namespace sgs
