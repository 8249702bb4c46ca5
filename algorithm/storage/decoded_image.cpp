// Decoding of all records, with checks.
#include "algorithm/storage/decoded_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

using Fault = std::optional<std::string>;

template <class Quaternion>
bool is_rotation(const Quaternion& quat) {
  constexpr double kRounding = 1e-5;  // rounding of components that were normalised in float
  double squared = 0;
  for (int k = 0; k < 4; ++k) squared += static_cast<double>(quat[k]) * quat[k];
  return std::abs(squared - 1) < kRounding;
}

Fault fault_of_entry(Codebook codebook, const float* words, std::uint32_t count) {
  for (std::uint32_t w = 0; w < count; ++w) {
    if (!std::isfinite(words[w])) {
      return fmt::format("word {}: got {}, expected a finite number", w, words[w]);
    }
    if (codebook == Codebook::kScale && !(words[w] >= 0 && words[w] <= 1)) {
      return fmt::format("word {}: got {}, expected a ratio of 0 to 1", w, words[w]);
    }
  }
  if (codebook == Codebook::kRotation && !is_rotation(words)) {
    return fmt::format("got ({}, {}, {}, {}), expected a quaternion of length 1", words[0],
                       words[1], words[2], words[3]);
  }
  return {};
}

void check_codebooks(const MemoryImage& image, const std::string& source) {
  const SecondHalfFormat& format = image.layout.second_half;
  const std::byte* codebooks = image.at(image.layout.codebooks.base);
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const auto codebook = static_cast<Codebook>(id);
    const std::uint32_t words = codebook_words(codebook, format.sh_degree);
    std::vector<float> entry(words);
    for (std::uint32_t e = 0; e < format.entries[id]; ++e) {
      const EntryRange range = format.entry(codebook, e);
      std::memcpy(entry.data(), codebooks + range.begin, range.bytes);
      if (const Fault fault = fault_of_entry(codebook, entry.data(), words)) {
        throw InputError(
            fmt::format("{}: codebook {}: entry {}: {}", source, kCodebookNames[id], e, *fault));
      }
    }
  }
}

Fault fault_of_indices(const SecondHalfFormat& format, const CodebookIndices& indices) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] > 0 && indices[id] >= format.entries[id]) {
      return fmt::format("index into codebook {}: got {}, expected less than {}",
                         kCodebookNames[id], indices[id], format.entries[id]);
    }
  }
  return {};
}

// NaN is not within.
bool within(const glm::vec3& v, double magnitude) {
  return std::abs(v.x) <= magnitude && std::abs(v.y) <= magnitude && std::abs(v.z) <= magnitude;
}

// The bound that the coarse filter goes by must not be less than the Gaussian.
Fault fault_of_bound(const SplitFirstHalf& first, const Gaussian<float>& g, CoarseBoundBy by) {
  const VisibleExtents least = visible_extents(g);
  const VisibleExtents& got = first.extents;
  if (by == CoarseBoundBy::kLargestScale) {
    if (got.scale_max == least.scale_max) return {};
    return fmt::format("scales: the largest is {}, the first half says {}", least.scale_max,
                       got.scale_max);
  }
  if (got.scale_max >= least.scale_max && got.extent.x >= least.extent.x &&
      got.extent.y >= least.extent.y && got.extent.z >= least.extent.z) {
    return {};
  }
  return fmt::format(
      "visible extents: got ({}, {}, {}) of a scale of {}, expected at least ({}, {}, {}) of {}",
      got.extent.x, got.extent.y, got.extent.z, got.scale_max, least.extent.x, least.extent.y,
      least.extent.z, least.scale_max);
}

Fault fault_of_values(const DecodedGaussian& decoded, int sh_degree) {
  constexpr double kRounding = 1 + 1e-5;  // rounding of an exponential in float
  const Gaussian<float>& g = decoded.gaussian;
  if (!within(g.mean, kMaxCoordinate)) {
    return fmt::format("centre: got ({}, {}, {}), expected magnitudes of at most {}", g.mean.x,
                       g.mean.y, g.mean.z, kMaxCoordinate);
  }
  if (!within(g.scale, kMaxScale * kRounding) || std::min({g.scale.x, g.scale.y, g.scale.z}) < 0) {
    return fmt::format("scales: got ({}, {}, {}), expected 0 to {}", g.scale.x, g.scale.y,
                       g.scale.z, kMaxScale);
  }
  if (!is_rotation(g.quat)) {
    return fmt::format("rotation: got ({}, {}, {}, {}), expected a quaternion of length 1",
                       g.quat[0], g.quat[1], g.quat[2], g.quat[3]);
  }
  if (!(g.opacity >= 0 && g.opacity <= 1)) {
    return fmt::format("opacity: got {}, expected 0 to 1", g.opacity);
  }
  for (int k = 0; k < sh_coeff_count(sh_degree); ++k) {
    if (within(decoded.sh[k], kMaxCoefficient)) continue;
    return fmt::format("SH coefficient {}: got ({}, {}, {}), expected magnitudes of at most {}", k,
                       decoded.sh[k].x, decoded.sh[k].y, decoded.sh[k].z, kMaxCoefficient);
  }
  return {};
}

}  // namespace

ActivatedCloud decode_image(const MemoryImage& image, const std::string& source) {
  check_codebooks(image, source);
  const SceneLayout& layout = image.layout;
  const SecondHalfFormat& format = layout.second_half;
  const std::byte* codebooks = image.at(layout.codebooks.base);
  const auto stride = static_cast<std::size_t>(sh_coeff_count(format.sh_degree));
  ActivatedCloud cloud;
  cloud.sh_degree = format.sh_degree;
  cloud.gaussians.resize(layout.gaussian_count());
  cloud.sh_coeffs.resize(layout.gaussian_count() * stride);
  const auto decode = [&](std::size_t at) -> Fault {
    const auto slot = static_cast<std::uint32_t>(at);
    const RecordSplit& split = layout.split;
    const SplitFirstHalf first =
        read_first_half(split, image.at(layout.first_halves.address(slot)));
    const std::byte* record = image.at(layout.second_halves.address(slot));
    Fault fault;
    if (format.quantised()) {
      fault = fault_of_indices(format, read_indices(split, format, first.carried, record));
    }
    if (!fault) {
      const DecodedGaussian decoded =
          read_record(split, format, first.mean, first.carried, record, codebooks);
      fault = fault_of_values(decoded, format.sh_degree);
      if (!fault) fault = fault_of_bound(first, decoded.gaussian, split.bound_by);
      cloud.gaussians[slot] = decoded.gaussian;
      std::copy_n(decoded.sh, stride, cloud.sh_coeffs.data() + slot * stride);
    }
    if (fault) return fmt::format("{}: Gaussian in slot {}: {}", source, slot, *fault);
    return {};
  };
  if (const Fault fault = first_fault(layout.gaussian_count(), decode)) throw InputError(*fault);
  return cloud;
}

}  // namespace sgs
