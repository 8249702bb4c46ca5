// The tunings of a scene, a file each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/dataset.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene_files/load_scene.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "algorithm/train/scene_tuner.h"
#include "algorithm/tune/group_sequences.h"
#include "testbench/streaminggs/fitting/tune_arguments.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {

// The pictures that a tuning compares with: photographs of a data set, or the scene's own reference
// pictures.
struct TuningViews {
  std::unique_ptr<const Dataset> dataset;  // the photographs are read from it
  std::vector<Camera> cameras;             // one for each view that is tuned on
  Photographs tune, test;                  // loaded
  std::string says;                        // a line for the terminal
};

// The views of a data set that has views to test with.
TuningViews views_of_dataset(Dataset dataset);

// The pictures that `cloud` gives from `cameras` in the reference order: of every eighth, from the
// first on, to test with and of the others to tune on; one camera serves for both. With
// between > 0 all of them are to test with, and so many between them (photographs.h), drawn by
// seed, are tuned on. pictures: what to call them on the terminal.
TuningViews views_of_scene(const std::string& pictures, const ActivatedCloud& cloud,
                           const std::vector<Camera>& cameras, std::uint32_t between,
                           std::uint64_t seed);

// Sizes of the pictures that are tuned on, in px.
std::vector<PixelSize> frame_sizes(const TuningViews& views);

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
