// Reading and storing.
#include "testbench/streaminggs/sweep/sweep_scene.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "algorithm/splat/activate.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_scene.h"
#include "modules/storage_keys.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/command_line/while_doing.h"

namespace sgs {

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

}  // namespace sgs
