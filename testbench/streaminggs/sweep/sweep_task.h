// One simulation of a sweep: a point, a scene, a view.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/vq/quantise.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "testbench/streaminggs/run/run_config.h"
#include "testbench/streaminggs/run/scene_arguments.h"
#include "testbench/streaminggs/sweep/sweep_points.h"
#include "testbench/streaminggs/sweep/sweep_record.h"

namespace sgs {

// A scene of a sweep: its file read once, its codebooks made once, whatever ways to store it points
// ask for.

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

struct SweepTask {
  PointInWords words;
  std::string id;  // the point's id
  ConfigSource config;
  SweepScene* scene = nullptr;
  int view = 0;
  Camera camera;
  std::string key;      // equal: the same result; empty: nothing is known well enough to keep one
  std::string refused;  // why there is nothing to simulate
  // Tasks of one storage next to each other in the order of these, and of one picture there.
  std::string storage, picture;
};

// Values for all points of a sweep that do not say otherwise.
struct SweepDefaults {
  SceneArguments any_scene;  // all but its name, cameras, view and size
  std::vector<SceneArguments> scenes;
  std::string view, size, stereo;
  ConfigSource config;
  std::uint64_t technology_hash = 0;  // hash of the table's file
};

class SweepPlan {
 public:
  SweepPlan(SweepDefaults defaults, const Kinds& kinds);

  // Throws InputError where a scene of the command line, its cameras or its views are not there, or
  // --stereo is none.
  // Returns remarks about their pictures.
  std::vector<std::string> check_scenes();

  // Those of a point: each of its scenes and views. One whose configuration cannot be is among
  // them, refused; so is a single one, without key, for a
  // point that has no scene or view.
  std::vector<SweepTask> tasks_of(const SweepPoint& point);

  // The configuration of a task, as far as it does not follow from the scene's Gaussians. Throws
  // InputError.
  RunConfig resolved(const SweepTask& task) const;

 private:
  SweepScene& scene_of(const SceneArguments& arguments);
  std::vector<SceneArguments> scenes_of(const SweepPoint& point) const;
  void resolve_and_name(SweepTask& task);

  const SweepDefaults defaults_;
  const Kinds& kinds_;
  const std::uint64_t program_hash_;
  std::map<std::string, std::unique_ptr<SweepScene>> scenes_;
  std::set<std::string> said_;  // notes, each once
};

}  // namespace sgs
