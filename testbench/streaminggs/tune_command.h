// What the tunings of a scene have in common: arguments, and what they begin with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/scene/load_scene.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/drawing_order.h"
#include "algorithm/train/penalties.h"
#include "algorithm/train/scene_tuner.h"
#include "algorithm/train/tuning_config.h"
#include "algorithm/tune/visit_plan.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/dataset_arguments.h"
#include "testbench/streaminggs/fitting_run.h"
#include "testbench/streaminggs/run_config.h"
#include "testbench/streaminggs/scene_arguments.h"
#include "testbench/streaminggs/tuning_views.h"

namespace sgs {

struct TuneArguments : SceneArguments, FittingArguments {
  bool boundary = false, quantise = false, streaming = false;
  DatasetArguments data;  // no folder: the scene's own pictures
  std::string target;     // scene whose pictures they are; empty: the one that is tuned
  std::uint32_t between = 0;
  ConfigSource config;
  std::uint32_t steps = 0;  // 0: as many as the paper takes
  std::uint64_t seed = 1;
  double rate = 0;  // 0: that of the tuning
  double beta = 0.05;
  std::string misordered_in = "group", penalty_mean = "rendered";
  std::uint32_t reassign_every = 100;
  double price = 0.01;
  static constexpr std::uint32_t kVisitMemoryMb = 1024;
  std::uint32_t visit_memory_mb = kVisitMemoryMb;

  std::size_t visit_bytes() const { return std::size_t{visit_memory_mb} * 1'000'000; }
  const char* purpose() const {
    return boundary ? "boundary" : quantise ? "quantise" : "streaming";
  }
  // What a checkpoint must have been made with.
  std::string work(const TuningConfig& config) const;
  // What all tunings take of it; steps, rate: where the user says none.
  void set(TuningConfig& config, int own_steps, double own_rate) const;
};

// Loaded and resolved for the scene.
struct TuningJob {
  Scene scene;
  TuningViews views;
  RunConfig config;
  std::string contents;  // digest of what was read
};

// A scene's Gaussians in the order of their storage, less those that are not stored.
struct CloudInStorage {
  StoredTable table;
  GaussianCloud cloud;
};
CloudInStorage in_storage(const GaussianCloud& cloud, const StorageConfig& storage);
// The scene as given. Throws InputError where nothing of it is stored.
CloudInStorage given_in_storage(const TuneArguments& arguments, const TuningJob& job);

// How the machine renders: in paper order, or, where nothing is returned, as the reference does.
// Throws InputError for what is not tuned for.
std::optional<PaperOrderConfig> tuned_order(const TuneArguments& arguments,
                                            const RunConfig& config);

// A tuner of what is written as .ply, at its beginning or from a checkpoint. given: in storage
// order. Throws InputError where the checkpoint is of another scene.
SceneTuner begun_tuner(const TuneArguments& arguments, const TuningJob& job,
                       const TuningConfig& config, DrawingOrder order, Penalty penalty,
                       const GaussianCloud& given, const std::optional<Checkpoint>& from);

void print_target(const TuningJob& job, std::size_t gaussians);
void print_visits(const VisitPlan& plan);

// Each returns the exit status. Throw InputError.
int tune_for_boundaries(const TuneArguments& arguments, const TuningJob& job);
int tune_for_streaming(const TuneArguments& arguments, const TuningJob& job);
int tune_for_codebooks(const TuneArguments& arguments, const TuningJob& job);

}  // namespace sgs
