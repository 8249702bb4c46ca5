// From a configuration to encoded, laid-out scenes, and from an image back to its scene.
#include "algorithm/storage/stored_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/vq/image_weights.h"

namespace sgs {

namespace {

// Most that bands 1 .. `degree` can add to one channel, [band]; bands from 1 on.
std::array<double, 4> most_of_bands(const glm::vec3* sh, int degree, int channel) {
  constexpr double kPi = 3.14159265358979323846;
  std::array<double, 4> most{};
  for (int band = 1; band <= degree; ++band) {
    double squares = 0;
    for (int k = band * band; k < (band + 1) * (band + 1); ++k) {
      squares += double{sh[k][channel]} * double{sh[k][channel]};
    }
    most[static_cast<std::size_t>(band)] = std::sqrt((2 * band + 1) / (4 * kPi) * squares);
  }
  return most;
}

// The bands of a scene's colours that are stored, and the scene whole where that is not all.
struct KeptBands {
  KeptBands(ActivatedCloud&& cloud, const StorageConfig& config)
      : bands(bands_to_store(cloud, config)),
        left_out(cloud.sh_degree - bands.degree),
        stored(left_out > 0 ? with_bands(cloud, bands.degree) : std::move(cloud)) {
    if (left_out > 0) whole = std::move(cloud);
  }
  ShBands bands;
  int left_out;
  ActivatedCloud stored;
  std::optional<ActivatedCloud> whole;
};

// original: what was encoded, where something was lost.
StoredScene arranged(EncodedCloud encoded, std::optional<ActivatedCloud> original,
                     const KeptBands& kept, const StorageConfig& config) {
  const StorageScheme& scheme = scheme_of(config.order);
  StoredScene out;
  out.storage = config;
  out.gaussians = encoded.decoded.size();
  out.sh_bands_left_out = kept.left_out;
  out.sh_error = kept.bands.most_error;
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

// encode(cloud): its second halves, with a loss.
template <class Encode>
StoredScene store_with_loss(KeptBands kept, const StorageConfig& config, Encode&& encode) {
  EncodedCloud encoded = encode(std::as_const(kept.stored));
  std::optional<ActivatedCloud> original = std::move(kept.whole ? *kept.whole : kept.stored);
  return arranged(std::move(encoded), std::move(original), kept, config);
}

}  // namespace

ShBands bands_to_store(const ActivatedCloud& cloud, const StorageConfig& config) {
  const int degree = cloud.sh_degree;
  if (config.sh_tolerance == 0) return {degree, 0};
  std::array<double, 4> error{};  // [degree] that is stored
  for (const std::uint32_t i : stored_gaussians(cloud, stored_of(config))) {
    for (int channel = 0; channel < 3; ++channel) {
      const std::array<double, 4> most = most_of_bands(cloud.sh(i), degree, channel);
      double beyond = 0;
      for (int kept = degree - 1; kept >= 0; --kept) {
        const auto at = static_cast<std::size_t>(kept);
        beyond += most[at + 1];
        error[at] = std::max(error[at], beyond);
      }
    }
  }
  for (int kept = 0; kept < degree; ++kept) {
    const double of_kept = error[static_cast<std::size_t>(kept)];
    if (of_kept <= config.sh_tolerance) return {kept, of_kept};
  }
  return {degree, 0};
}

ActivatedCloud with_bands(const ActivatedCloud& cloud, int degree) {
  ActivatedCloud out;
  out.sh_degree = degree;
  out.gaussians = cloud.gaussians;
  const auto kept = static_cast<std::size_t>(sh_coeff_count(degree));
  out.sh_coeffs.reserve(cloud.size() * kept);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out.sh_coeffs.insert(out.sh_coeffs.end(), cloud.sh(i), cloud.sh(i) + kept);
  }
  return out;
}

StoredScene store_scene(ActivatedCloud cloud, const StorageConfig& config,
                        const std::vector<Camera>& weighing, const VqProgress& progress) {
  scheme_of(config.order).check(config);  // before anything is computed
  KeptBands kept(std::move(cloud), config);
  switch (config.encoding) {
    case SecondHalfEncoding::kRaw: {
      EncodedCloud encoded = encode_raw(std::move(kept.stored));
      return arranged(std::move(encoded), std::move(kept.whole), kept, config);
    }
    case SecondHalfEncoding::kHalf:
      return store_with_loss(std::move(kept), config, encode_half);
    default:
      return store_with_loss(std::move(kept), config, [&](const ActivatedCloud& stored) {
        return encode_quantised(stored, quantise_scene(stored, config.vq, weighing, progress),
                                config.encoding);
      });
  }
}

QuantisedCloud quantise_scene(const ActivatedCloud& cloud, const VqConfig& config,
                              const std::vector<Camera>& weighing, const VqProgress& progress) {
  return quantise(cloud, image_weights(cloud, weighing), pixel_sizes(cloud, weighing), config,
                  progress);
}

StoredScene store_quantised(ActivatedCloud cloud, const QuantisedCloud& quantised,
                            const StorageConfig& config) {
  scheme_of(config.order).check(config);
  return store_with_loss(KeptBands(std::move(cloud), config), config,
                         [&](const ActivatedCloud& stored) {
                           return encode_quantised(stored, quantised, config.encoding);
                         });
}

StoredScene restore_scene(PackedScene packed, const std::string& source) {
  StoredScene out;
  out.gaussians = packed.facts.gaussians;
  out.decoded = decode_image(packed.image, source);
  out.table = scheme_of(packed.storage.order).restore(packed, out.decoded, source);
  out.storage = packed.storage;
  out.sh_bands_left_out = packed.facts.sh_bands_left_out;
  out.sh_error = out.sh_bands_left_out > 0 ? packed.storage.sh_tolerance : 0;  // at most
  out.image = std::move(packed.image);
  return out;
}

}  // namespace sgs
