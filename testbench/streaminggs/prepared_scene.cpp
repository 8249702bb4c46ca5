// Storing of a scene, or restoring of a packed one.
#include "testbench/streaminggs/prepared_scene.h"

#include "algorithm/splat/activate.h"
#include "algorithm/storage/restore_scene.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/store_scene.h"
#include "testbench/streaminggs/progress.h"

namespace sgs {
namespace {

void choose_storage(const ActivatedCloud& cloud, RunConfig& config) {
  config.add_choices(scheme_of(config.storage.order).choose(config.storage, cloud));
}

}  // namespace

void adapt(RunConfig& config, const Scene& scene) {
  choose_storage(activate(scene.cloud), config);
  adapt(config, SecondHalfFormat{config.storage.encoding, scene.cloud.sh_degree, {}});
}

void adapt(RunConfig& config, const PackedScene& packed) {
  adapt(config, packed.image.layout.second_half);
}

PreparedScene prepare(Scene scene, RunConfig& config, const std::vector<Camera>& weighing) {
  ActivatedCloud cloud = activate(scene.cloud);
  choose_storage(cloud, config);
  const ProgressLine progress;
  PreparedScene prepared{std::move(scene.name), scene.dropped_invalid, {}};
  naming_origins(config, [&] {
    prepared.stored =
        store_scene(std::move(cloud), config.storage, weighing, progress.of_quantisation());
  });
  adapt(config, prepared.stored.image.layout.second_half);
  return prepared;
}

PreparedScene prepare(PackedScene packed, const std::string& path, RunConfig& config) {
  adapt(config, packed);
  PreparedScene prepared{packed.facts.name, packed.facts.dropped_invalid, {}};
  prepared.stored = restore_scene(std::move(packed), path);
  return prepared;
}

}  // namespace sgs
