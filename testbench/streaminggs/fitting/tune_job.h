// The inputs that all tunings of a scene begin with.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/scene_files/load_scene.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/scene_tuner.h"
#include "algorithm/train/tuning_config.h"
#include "algorithm/tune/visited_sequences.h"
#include "testbench/streaminggs/fitting/tune_arguments.h"
#include "testbench/streaminggs/fitting/tuning_views.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {

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

}  // namespace sgs
