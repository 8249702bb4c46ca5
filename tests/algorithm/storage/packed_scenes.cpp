// Making of small packed scenes.
#include "tests/algorithm/storage/packed_scenes.h"

#include <algorithm>

#include "algorithm/splat/activate.h"
#include "algorithm/storage/stored_scene.h"
#include "testbench/builtin/builtin_scene.h"

namespace sgs::test {

ActivatedCloud cut_object(std::uint32_t count, int sh_degree) {
  const ActivatedCloud full =
      activate(make_builtin_scene("builtin:object?n=" + std::to_string(count)).cloud);
  ActivatedCloud cut;
  cut.sh_degree = sh_degree;
  cut.gaussians = full.gaussians;
  const int coeffs = (sh_degree + 1) * (sh_degree + 1);
  for (std::size_t i = 0; i < full.size(); ++i) {
    cut.sh_coeffs.insert(cut.sh_coeffs.end(), full.sh(i), full.sh(i) + coeffs);
    if (i % 7 == 3) cut.gaussians[i].opacity = 0.001F;
    if (i % 5 == 4) cut.gaussians[i].mean = cut.gaussians[i - 3].mean;
  }
  return cut;
}

StorageConfig small_storage(SecondHalfEncoding encoding, StorageOrder order) {
  StorageConfig storage;
  storage.order = order;
  storage.encoding = encoding;
  if (order == StorageOrder::kVoxels) storage.voxel_size = 0.4;
  storage.vq.scale_entries = 21;
  storage.vq.rotation_entries = 40;
  storage.vq.dc_entries = 17;
  storage.vq.sh_entries = 9;
  storage.vq.iterations = 2;
  return storage;
}

Packing make_packing(const ActivatedCloud& cloud, SecondHalfEncoding encoding, StorageOrder order) {
  return {store_scene(cloud, small_storage(encoding, order), {}), {"object", cloud.size(), 3}};
}

}  // namespace sgs::test
