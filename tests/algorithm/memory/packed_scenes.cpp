// Making of small packed scenes.
#include "tests/algorithm/memory/packed_scenes.h"

#include <algorithm>

#include "algorithm/scene/builtin_scene.h"
#include "algorithm/splat/activate.h"

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

Packing make_packing(const ActivatedCloud& cloud, SecondHalfEncoding encoding, StorageOrder order) {
  Packing packing;
  PackedFacts& facts = packing.facts;
  facts.name = "object";
  facts.gaussians = cloud.size();
  facts.dropped_invalid = 3;
  facts.vq.scale_entries = 21;  // no power of two: indices beyond are possible
  facts.vq.rotation_entries = 40;
  facts.vq.dc_entries = 17;
  facts.vq.sh_entries = 9;
  facts.vq.iterations = 2;
  const auto encode = [&] {
    if (encoding == SecondHalfEncoding::kRaw) return encode_raw(cloud);
    if (encoding == SecondHalfEncoding::kHalf) return encode_half(cloud);
    return encode_quantised(cloud,
                            quantise(cloud, std::vector<float>(cloud.size(), 1.0F),
                                     std::vector<float>(cloud.size(), 0.0F), facts.vq),
                            encoding);
  };
  if (order == StorageOrder::kChunks) {
    facts.chunk_gaussians = 16;
    packing.stored = store_by_chunks(encode(), facts.chunk_gaussians, facts.stored);
  } else {
    packing.stored = store_by_voxels(encode(), 0.4F, facts.stored);
  }
  return packing;
}

}  // namespace sgs::test
