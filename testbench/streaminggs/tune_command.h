// What the tunings of a scene have in common: arguments, and what they begin with.
#pragma once

#include <cstdint>
#include <string>

#include "algorithm/scene/load_scene.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/fitting_run.h"
#include "testbench/streaminggs/run_config.h"
#include "testbench/streaminggs/scene_arguments.h"
#include "testbench/streaminggs/tuning_views.h"

namespace sgs {

struct TuneArguments : SceneArguments, FittingArguments {
  bool boundary = false;
  std::string data;  // folder of a data set; empty: the scene's own pictures
  std::uint32_t between = 0;
  ConfigSource config;
  std::uint32_t steps = 0;  // 0: as many as the paper takes
  std::uint64_t seed = 1;
  double rate = 1;
  double beta = 0.05;
  std::string misordered_in = "group", penalty_mean = "rendered";
  std::uint32_t visit_memory_mb = 1024;

  // What a checkpoint must have been made with. steps: in all.
  std::string work(std::uint32_t steps) const;
};

// Loaded and resolved for the scene.
struct TuningJob {
  Scene scene;
  TuningViews views;
  RunConfig config;
};

// Each returns the exit status. Throw InputError.
int tune_for_boundaries(const TuneArguments& arguments, const TuningJob& job);

}  // namespace sgs
