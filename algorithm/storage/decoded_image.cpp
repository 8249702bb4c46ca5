// Decoding of all records, with checks.
#include "algorithm/storage/decoded_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algorithm/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/gaussian_limits.h"
#include "algorithm/storage/first_fault.h"

namespace sgs {
namespace {

using Fault = std::optional<std::string>;

template <class Quaternion>
bool is_rotation(const Quaternion& quat) {
  constexpr double kRounding = 1e-5;  // of components that were normalised in float
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

Fault fault_of_indices(const SecondHalfFormat& format, const std::byte* record) {
  const CodebookIndices indices = decode_indices(format, record);
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

Fault fault_of_values(const FirstHalf& first, const DecodedGaussian& decoded, int sh_degree) {
  constexpr double kRounding = 1 + 1e-5;  // of an exponential in float
  const Gaussian<float>& g = decoded.gaussian;
  if (!within(g.mean, kMaxCoordinate)) {
    return fmt::format("centre: got ({}, {}, {}), expected magnitudes of at most {}", g.mean.x,
                       g.mean.y, g.mean.z, kMaxCoordinate);
  }
  if (!within(g.scale, kMaxScale * kRounding) || std::min({g.scale.x, g.scale.y, g.scale.z}) < 0 ||
      std::max({g.scale.x, g.scale.y, g.scale.z}) != first.scale_max) {
    return fmt::format("scales: got ({}, {}, {}), expected 0 to the largest, {}, itself at most {}",
                       g.scale.x, g.scale.y, g.scale.z, first.scale_max, kMaxScale);
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
    const FirstHalf first = decode_first_half(image.at(layout.first_halves.address(slot)));
    const std::byte* record = image.at(layout.second_halves.address(slot));
    Fault fault;
    if (format.quantised()) fault = fault_of_indices(format, record);
    if (!fault) {
      const DecodedGaussian decoded = decode_second_half(format, first, record, codebooks);
      fault = fault_of_values(first, decoded, format.sh_degree);
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
