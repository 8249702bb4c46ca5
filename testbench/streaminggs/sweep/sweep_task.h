// One simulation of a sweep: a point, a scene, a view.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/scene/camera.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/run/run_config.h"
#include "testbench/streaminggs/run/scene_arguments.h"
#include "testbench/streaminggs/sweep/sweep_points.h"
#include "testbench/streaminggs/sweep/sweep_record.h"
#include "testbench/streaminggs/sweep/sweep_scene.h"

namespace sgs {

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
  std::string view, size;
  ConfigSource config;
  std::uint64_t technology_hash = 0;  // hash of the table's file
};

class SweepPlan {
 public:
  SweepPlan(SweepDefaults defaults, const Kinds& kinds);

  // Throws InputError where a scene of the command line, its cameras or its views are not there.
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
