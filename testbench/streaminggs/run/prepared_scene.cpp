// Storing of a scene, or restoring of a packed one.
#include "testbench/streaminggs/run/prepared_scene.h"

#include <utility>

#include "algorithm/splat/activate.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_scene.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/run/progress.h"

namespace sgs {
namespace {

void choose_storage(const ActivatedCloud& cloud, RunConfig& config) {
  config.add_choices(scheme_of(config.storage.order).choose(config.storage, cloud));
}

// Codebooks are made of what is stored.
QuantisedCloud quantised_bands(const ActivatedCloud& cloud, const StorageConfig& storage,
                               const Quantise& quantise) {
  const int degree = bands_to_store(cloud, storage).degree;
  return degree == cloud.sh_degree ? quantise(cloud, storage.vq)
                                   : quantise(with_bands(cloud, degree), storage.vq);
}

}  // namespace

void adapt(RunConfig& config, const Scene& scene) {
  const ActivatedCloud cloud = activate(scene.cloud);
  choose_storage(cloud, config);
  const int degree = bands_to_store(cloud, config.storage).degree;
  adapt(config, SecondHalfFormat{config.storage.encoding, degree, {}});
}

void adapt(RunConfig& config, const PackedScene& packed) {
  adapt(config, packed.image.layout.second_half);
}

void adapt(RunConfig& config, const PreparedScene& scene) {
  config.storage = scene.stored.storage;
  config.add_choices(scene.choices);
  adapt(config, scene.stored.image.layout.second_half);
}

PreparedScene store(std::string name, std::uint64_t dropped_invalid, ActivatedCloud cloud,
                    const RunConfig& config, const Quantise& quantise) {
  PreparedScene out{std::move(name), dropped_invalid, {}};
  StorageConfig storage = config.storage;
  const StorageScheme& scheme = scheme_of(storage.order);
  out.choices = scheme.choose(storage, cloud);
  naming_origins(config, [&] {
    scheme.check(storage);  // before anything is computed
    if (SecondHalfFormat{storage.encoding, 0, {}}.quantised()) {
      const QuantisedCloud quantised = quantised_bands(cloud, storage, quantise);
      out.stored = store_quantised(std::move(cloud), quantised, storage);
    } else {
      out.stored = store_scene(std::move(cloud), storage, {});
    }
  });
  out.image_hash = xxh64(out.stored.image.bytes);
  return out;
}

PreparedScene restore(PackedScene packed, const std::string& path) {
  PreparedScene prepared{packed.facts.name, packed.facts.dropped_invalid, {}};
  prepared.stored = restore_scene(std::move(packed), path);
  prepared.image_hash = xxh64(prepared.stored.image.bytes);
  return prepared;
}

PreparedScene prepare(Scene scene, RunConfig& config, const std::vector<Camera>& weighing,
                      const CodebookCache& cache) {
  const ProgressLine progress;
  const Quantise quantise = [&](const ActivatedCloud& cloud, const VqConfig& vq) {
    return cache.codebooks(cloud, vq, weighing, [&] {
      return quantise_scene(cloud, vq, weighing, progress.of_quantisation());
    });
  };
  ActivatedCloud cloud = activate(scene.cloud);
  scene.cloud = {};
  PreparedScene prepared =
      store(std::move(scene.name), scene.dropped_invalid, std::move(cloud), config, quantise);
  prepared.axes = std::move(scene.axes);
  adapt(config, prepared);
  return prepared;
}

PreparedScene prepare(PackedScene packed, const std::string& path, RunConfig& config) {
  adapt(config, packed);
  return restore(std::move(packed), path);
}

}  // namespace sgs
