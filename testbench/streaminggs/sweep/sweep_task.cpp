// From points to tasks, and their keys.
#include "testbench/streaminggs/sweep/sweep_task.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_scene.h"
#include "modules/dram/memspec.h"
#include "modules/storage_keys.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/command_line/guard.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/run/second_eye.h"

namespace sgs {

namespace {

PointInWords in_words(const SceneArguments& scene, const std::string& stereo,
                      const ConfigSource& config) {
  return {scene.scene, scene.cameras_path, scene.view,       scene.size,
          stereo,      config.config,      config.overrides, config.fit_memories};
}

const std::string& either(const std::string& said, const std::string& otherwise) {
  return said.empty() ? otherwise : said;
}

}  // namespace

std::uint64_t size_bytes(const PreparedScene& scene) {
  // The bytes of the image, and clouds of about as many.
  return scene.stored.image.bytes.size() * (scene.stored.original ? 3 : 2);
}

SweepScene::SweepScene(SceneArguments arguments) : arguments_(std::move(arguments)) {
  if (is_builtin_scene(arguments_.scene)) {
    // A built-in scene follows from its text and from the program, which stands in every key.
    digest_ = xxh64_of_text(arguments_.scene);
    cloud();
    return;
  }
  packed_ = arguments_.load_packed();
  if (!packed_) arguments_.check_file();
  const std::vector<std::string> files = files_of_scene(arguments_.scene, arguments_.reading());
  digest_ =
      files.size() == 1 ? xxh64_of_file(files.front()) : xxh64_of_text(digest_of_files(files));
  if (arguments_.level) {
    digest_ = xxh64_of_text(fmt::format("{:016x} level {}", digest_, *arguments_.level));
  }
  if (!arguments_.axes.empty()) {
    digest_ = xxh64_of_text(fmt::format("{:016x} axes {}", digest_, arguments_.axes));
  }
}

const ActivatedCloud& SweepScene::cloud() {
  if (cloud_) return *cloud_;
  Scene scene = arguments_.load();
  name_ = std::move(scene.name);
  dropped_invalid_ = scene.dropped_invalid;
  axes_ = std::move(scene.axes);
  own_cameras_ = std::move(scene.cameras);
  return cloud_.emplace(activate(scene.cloud));
}

const ChosenCameras& SweepScene::cameras(const std::string& view, const std::string& size) {
  const std::string key = view + " " + size;
  if (const auto known = cameras_.find(key); known != cameras_.end()) return known->second;
  SceneArguments of_view = arguments_;
  of_view.view = view;
  of_view.size = size;
  return cameras_.emplace(key, of_view.chosen_cameras(own_cameras_)).first->second;
}

void SweepScene::resolve(RunConfig& config, const std::string& preset) const {
  if (packed_) {
    sgs::resolve(config, *packed_, arguments_.scene, preset);
  } else {
    sgs::resolve(config);
  }
}

std::vector<Camera> SweepScene::weighing(const RunConfig& config) const {
  const SecondHalfEncoding encoding = config.storage.encoding;
  // Read and checked where it is asked for, also in vain.
  if (!SecondHalfFormat{encoding, 0, {}}.quantised() && arguments_.weigh_by.empty()) return {};
  return arguments_.weighing_cameras(own_cameras_, encoding);
}

std::string SweepScene::storage_key(RunConfig& config) const {
  if (packed_) return "packed";
  std::string key =
      fmt::format("{} {}", scheme_of(config.storage.order).name(), config_to_json(config.storage));
  for (const Camera& camera : weighing(config)) key += text_of(camera) + "\n";
  return key;
}

PreparedScene SweepScene::prepared(RunConfig& config, const VqProgress& progress) {
  if (packed_) {
    PackedScene packed =
        packed_->image.bytes.empty() ? *arguments_.load_packed() : std::move(*packed_);
    packed_.emplace();
    packed_->facts = packed.facts;
    packed_->storage = packed.storage;
    packed_->image.layout = packed.image.layout;
    packed_->checksum = packed.checksum;
    return restore(std::move(packed), arguments_.scene);
  }
  const Quantise quantise = [&](const ActivatedCloud& cloud, const VqConfig& vq) {
    std::string key = fmt::format("{} {}", cloud.sh_degree, config_to_json(vq));
    const std::vector<Camera> cameras = weighing(config);
    for (const Camera& camera : cameras) key += text_of(camera) + "\n";
    const auto known = codebooks_.find(key);
    if (known != codebooks_.end()) return known->second;
    return codebooks_.emplace(key, quantise_scene(cloud, vq, cameras, progress)).first->second;
  };
  const ActivatedCloud& read = cloud();  // and with it the name
  PreparedScene prepared = store(name_, dropped_invalid_, read, config, quantise);
  prepared.axes = axes_;
  return prepared;
}

SweepPlan::SweepPlan(SweepDefaults defaults, const Kinds& kinds)
    : defaults_(std::move(defaults)),
      kinds_(kinds),
      program_hash_(xxh64_of_file("/proc/self/exe")) {}

SweepScene& SweepPlan::scene_of(const SceneArguments& arguments) {
  std::unique_ptr<SweepScene>& scene = scenes_[arguments.scene + "\n" + arguments.cameras_path];
  if (!scene) scene = std::make_unique<SweepScene>(arguments);
  return *scene;
}

std::vector<SceneArguments> SweepPlan::scenes_of(const SweepPoint& point) const {
  std::vector<SceneArguments> scenes = defaults_.scenes;
  if (!point.scene.empty()) {
    SceneArguments named = defaults_.any_scene;
    // One of the command line's brings its cameras.
    for (const SceneArguments& known : scenes) {
      if (known.scene == point.scene) named = known;
    }
    named.scene = point.scene;
    scenes = {named};
  }
  if (scenes.empty()) throw InputError("scene: got none, expected one here or on the command line");
  for (SceneArguments& scene : scenes) {
    scene.cameras_path = either(point.cameras, scene.cameras_path);
    scene.view = either(point.view, defaults_.view);
    scene.size = either(point.size, defaults_.size);
  }
  return scenes;
}

std::vector<std::string> SweepPlan::check_scenes() {
  std::vector<std::string> notes;
  eyes_apart(defaults_.stereo);
  for (const SceneArguments& scene : defaults_.scenes) {
    const auto& said = scene_of(scene).cameras(defaults_.view, defaults_.size).notes;
    notes.insert(notes.end(), said.begin(), said.end());
  }
  return notes;
}

RunConfig SweepPlan::resolved(const SweepTask& task) const {
  RunConfig config = read_run_config(task.config, kinds_);
  draw_eyes(config, task.camera.eyes_apart);
  config.design->fit_frames([&] {
    return std::vector<PixelSize>{{task.camera.width, task.camera.height}};
  });
  task.scene->resolve(config, task.config.preset_in_words());
  return config;
}

void SweepPlan::resolve_and_name(SweepTask& task) {
  const SceneArguments& scene = task.scene->arguments();
  std::string all =
      fmt::format("{:016x} {:016x} {:016x} {} {} {}\n", program_hash_, defaults_.technology_hash,
                  task.scene->digest(), scene.drop_invalid, task.view, text_of(task.camera));
  try {
    RunConfig config = resolved(task);
    if (!config.sizes_replaced.empty() && said_.insert(config.sizes_replaced).second) {
      fmt::print(stderr, "streaminggs: note: {}\n", config.sizes_replaced);
    }
    task.storage = task.scene->storage_key(config);
    const std::string text = to_json(config), golden = config.design->golden_key();
    task.picture = golden.empty() ? text : fmt::format("{} {}", config.machine(), golden);
    all += fmt::format("{:016x} {}\n{}", xxh64_of_file(memspec_path(config.dram.memspec)),
                       task.storage, text);
    for (const AutoChoice& choice : config.chosen) all += "\n" + choice.key;
  } catch (const InputError& error) {
    task.refused = error.what();
    all += task.refused + "\n" + task.config.config;
    for (const std::string& assignment : task.config.overrides) all += "\n" + assignment;
  }
  task.key = fmt::format("{:016x}", xxh64_of_text(all));
}

std::vector<SweepTask> SweepPlan::tasks_of(const SweepPoint& point) {
  SweepTask base;
  base.id = point.id;
  base.config = {either(point.config, defaults_.config.config), defaults_.config.overrides,
                 point.fit_memories.value_or(defaults_.config.fit_memories)};
  base.config.overrides.insert(base.config.overrides.end(), point.overrides.begin(),
                               point.overrides.end());
  const std::string& stereo = either(point.stereo, defaults_.stereo);
  const auto refused = [&](const SceneArguments& scene, const std::string& why) {
    SweepTask task = base;
    task.words = in_words(scene, stereo, base.config);
    task.refused = why;
    return task;
  };
  if (!point.refused.empty()) return {refused({}, point.refused)};
  std::vector<SweepTask> tasks;
  try {
    const double apart = eyes_apart(stereo);
    for (const SceneArguments& arguments : scenes_of(point)) {
      try {
        SweepScene& scene = scene_of(arguments);
        for (const auto& [view, camera] : scene.cameras(arguments.view, arguments.size).views) {
          SweepTask task = base;
          task.words = in_words(arguments, stereo, base.config);
          task.words.view = std::to_string(view);
          task.scene = &scene;
          task.view = view;
          task.camera = camera;
          task.camera.eyes_apart = apart;
          resolve_and_name(task);
          tasks.push_back(std::move(task));
        }
      } catch (const InputError& error) {
        tasks.push_back(refused(arguments, error.what()));
      }
    }
  } catch (const InputError& error) {
    tasks.push_back(refused({}, error.what()));
  }
  return tasks;
}

}  // namespace sgs
