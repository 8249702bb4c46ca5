// Encoding and decoding of whole scenes.
#include "algorithm/storage/encoded_cloud.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

namespace {

// Writes each record by `write(index, out)` and reads it back into `decoded`.
template <class Write>
void fill(const ActivatedCloud& cloud, EncodedCloud& out, Write&& write) {
  const SecondHalfFormat& format = out.format;
  const auto stride = static_cast<std::size_t>(sh_coeff_count(format.sh_degree));
  out.records.resize(cloud.size() * format.bytes());
  out.decoded.sh_degree = format.sh_degree;
  out.decoded.gaussians.resize(cloud.size());
  out.decoded.sh_coeffs.resize(cloud.size() * stride);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cloud.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      std::byte* record = out.records.data() + i * format.bytes();
      write(i, record);
      std::byte first[kFirstHalfBytes];
      encode_first_half(cloud.gaussians[i], first);
      const DecodedGaussian back =
          decode_second_half(format, decode_first_half(first), record, out.codebooks.data());
      out.decoded.gaussians[i] = back.gaussian;
      std::copy_n(back.sh, stride,
                  out.decoded.sh_coeffs.begin() + static_cast<std::ptrdiff_t>(i * stride));
    }
  });
}

}  // namespace

void EncodedCloud::write_second_half(std::size_t index, std::byte* out) const {
  if (format.encoding == SecondHalfEncoding::kRaw) {
    encode_raw_second_half(decoded.gaussians[index], decoded.sh(index), format.sh_degree, out);
    return;
  }
  std::memcpy(out, records.data() + index * format.bytes(), format.bytes());
}

EncodedCloud reordered(EncodedCloud encoded, const std::vector<std::uint32_t>& order) {
  encoded.decoded = reordered(encoded.decoded, order);
  if (encoded.records.empty()) return encoded;
  const std::size_t bytes = encoded.format.bytes();
  std::vector<std::byte> records(order.size() * bytes);
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::memcpy(records.data() + i * bytes, encoded.records.data() + order[i] * bytes, bytes);
  }
  encoded.records = std::move(records);
  return encoded;
}

EncodedCloud encode_raw(ActivatedCloud cloud) {
  EncodedCloud out;
  out.format.sh_degree = cloud.sh_degree;
  out.decoded = std::move(cloud);
  return out;
}

EncodedCloud encode_half(const ActivatedCloud& cloud) {
  EncodedCloud out;
  out.format.encoding = SecondHalfEncoding::kHalf;
  out.format.sh_degree = cloud.sh_degree;
  fill(cloud, out, [&](std::size_t i, std::byte* record) {
    encode_half_second_half(cloud.gaussians[i], cloud.sh(i), cloud.sh_degree, record);
  });
  return out;
}

EncodedCloud encode_quantised(const ActivatedCloud& cloud, const QuantisedCloud& quantised,
                              SecondHalfEncoding encoding) {
  EncodedCloud out;
  out.format.encoding = encoding;
  out.format.sh_degree = cloud.sh_degree;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const std::vector<float>& words = quantised.codebooks[id];
    if (words.empty()) continue;
    const auto* bytes = reinterpret_cast<const std::byte*>(words.data());
    out.codebooks.insert(out.codebooks.end(), bytes, bytes + words.size() * sizeof(float));
    out.format.entries[id] = static_cast<std::uint32_t>(
        words.size() / codebook_words(static_cast<Codebook>(id), cloud.sh_degree));
  }
  fill(cloud, out, [&](std::size_t i, std::byte* record) {
    CodebookIndices indices{};
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      if (!quantised.indices[id].empty()) indices[id] = quantised.indices[id][i];
    }
    encode_quantised_second_half(out.format, indices, quantised.opacities[i], record);
  });
  return out;
}

MemoryImage store_gaussians(const EncodedCloud& scene, SceneLayout layout) {
  MemoryImage image{std::move(layout), {}};
  image.bytes.resize(image.layout.stored_bytes);
  const RecordArray &first_halves = image.layout.first_halves,
                    &second_halves = image.layout.second_halves;
  store_table(scene.codebooks, image.layout.codebooks.base, image);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, scene.decoded.size(), 4096), [&](const auto& range) {
        for (std::size_t slot = range.begin(); slot != range.end(); ++slot) {
          std::byte encoded[kMaxSecondHalfBytes];
          scene.write_second_half(slot, encoded);
          write_record(image.layout.split, image.layout.second_half, scene.decoded.gaussians[slot],
                       encoded, image.bytes.data() + first_halves.address(slot),
                       image.bytes.data() + second_halves.address(slot));
        }
      });
  return image;
}

}  // namespace sgs
