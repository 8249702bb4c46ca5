// A scene of a sweep: its file read once, its codebooks made once, whatever ways to store it points
// ask for.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/vq/quantise.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "testbench/streaminggs/run/run_config.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {

class SweepScene {
 public:
  // arguments: `view` and `size` are not looked at. Throws InputError when there is no such scene;
  // reads of a .ply file nothing yet.
  explicit SweepScene(SceneArguments arguments);

  const SceneArguments& arguments() const { return arguments_; }

  // Digest of the bytes that the scene is made from.
  std::uint64_t digest() const { return digest_; }

  // Throws InputError.
  const ChosenCameras& cameras(const std::string& view, const std::string& size);

  // All of a configuration that does not follow from the Gaussians. preset: as for resolve() of a
  // packed scene. Throws InputError.
  void resolve(RunConfig& config, const std::string& preset) const;

  // The values that prepared() depends on beside the scene, as a text. Throws InputError.
  std::string storage_key(RunConfig& config) const;

  // The scene stored as a resolved configuration says, or restored; the configuration is not
  // changed. progress: of codebooks that are made. Throws InputError.
  PreparedScene prepared(RunConfig& config, const VqProgress& progress);

 private:
  const ActivatedCloud& cloud();
  std::vector<Camera> weighing(const RunConfig& config) const;

  SceneArguments arguments_;
  std::uint64_t digest_ = 0;
  std::string name_;
  std::uint64_t dropped_invalid_ = 0;
  std::string axes_;
  std::vector<Camera> own_cameras_;
  std::optional<PackedScene> packed_;  // without its bytes once they were used
  std::optional<ActivatedCloud> cloud_;
  std::map<std::string, ChosenCameras> cameras_;
  std::map<std::string, QuantisedCloud> codebooks_;
};

// About what a prepared scene takes of memory.
std::uint64_t size_bytes(const PreparedScene& scene);

}  // namespace sgs
