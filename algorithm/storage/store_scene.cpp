// From a configuration to encoded, laid-out scenes.
#include "algorithm/storage/store_scene.h"

#include <optional>
#include <utility>

#include "algorithm/splat/reorder.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/vq/image_weights.h"

namespace sgs {
namespace {

EncodedCloud encode(const ActivatedCloud& cloud, const StorageConfig& config,
                    const std::vector<Camera>& weighing, const VqProgress& progress) {
  if (config.encoding == SecondHalfEncoding::kHalf) return encode_half(cloud);
  return encode_quantised(cloud, quantise_scene(cloud, config.vq, weighing, progress),
                          config.encoding);
}

// original: what was encoded, where something was lost.
StoredScene arranged(EncodedCloud encoded, std::optional<ActivatedCloud> original,
                     const StorageConfig& config) {
  const StorageScheme& scheme = scheme_of(config.order);
  StoredScene out;
  out.storage = config;
  out.gaussians = encoded.decoded.size();
  // From here on there is no other order than that of storage.
  Arrangement<StoredTable> arrangement = scheme.arrange(encoded.decoded, config);
  const std::vector<std::uint32_t>& order = arrangement.storage_order;
  encoded = reordered(std::move(encoded), order);
  if (original) out.original = reordered(*original, order);
  out.image = scheme.image_of(encoded, arrangement.table);
  out.table = std::move(arrangement.table);
  out.decoded = std::move(encoded.decoded);
  out.file_indices = std::move(arrangement.storage_order);
  return out;
}

}  // namespace

StoredScene store_scene(ActivatedCloud cloud, const StorageConfig& config,
                        const std::vector<Camera>& weighing, const VqProgress& progress) {
  scheme_of(config.order).check(config);  // before the work
  if (config.encoding == SecondHalfEncoding::kRaw) {
    return arranged(encode_raw(std::move(cloud)), {}, config);
  }
  EncodedCloud encoded = encode(cloud, config, weighing, progress);
  return arranged(std::move(encoded), std::move(cloud), config);
}

QuantisedCloud quantise_scene(const ActivatedCloud& cloud, const VqConfig& config,
                              const std::vector<Camera>& weighing, const VqProgress& progress) {
  return quantise(cloud, image_weights(cloud, weighing), pixel_sizes(cloud, weighing), config,
                  progress);
}

StoredScene store_quantised(ActivatedCloud cloud, const QuantisedCloud& quantised,
                            const StorageConfig& config) {
  scheme_of(config.order).check(config);
  EncodedCloud encoded = encode_quantised(cloud, quantised, config.encoding);
  return arranged(std::move(encoded), std::move(cloud), config);
}

}  // namespace sgs
