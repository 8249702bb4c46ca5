// Storing of a scene: encoded, sorted and laid out as a storage configuration says.
#pragma once

#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

// weighing: cameras that weigh the Gaussians where codebooks are made; progress: of that. Throws
// InputError where a size is still to be chosen (storage_scheme.h), or voxels are too small for the
// scene.
StoredScene store_scene(ActivatedCloud cloud, const StorageConfig& config,
                        const std::vector<Camera>& weighing, const VqProgress& progress = {});

// The codebooks of a scene, and their indices: what store_scene makes for vq and vq_packed,
// whatever the order.
QuantisedCloud quantise_scene(const ActivatedCloud& cloud, const VqConfig& config,
                              const std::vector<Camera>& weighing, const VqProgress& progress = {});

// Of a scene that was quantised elsewhere. quantised: of this cloud, with the bands that are stored
// (sh_bands.h), whose centres, largest scales and order are stored as they are; config's encoding:
// vq or vq_packed.
StoredScene store_quantised(ActivatedCloud cloud, const QuantisedCloud& quantised,
                            const StorageConfig& config);

}  // namespace sgs
