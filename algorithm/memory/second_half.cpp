// Writing and reading of second halves.
#include "algorithm/memory/second_half.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

namespace {

constexpr float kOpacityLevels = 255;
constexpr float kLargestHalf = 65504;
constexpr std::uint32_t kIndexBytes = 4;  // an index of kVq

std::uint16_t half_bits(float value) {
  return Imath::half(std::clamp(value, -kLargestHalf, kLargestHalf)).bits();
}

float half_value(std::uint16_t bits) {
  Imath::half value;
  value.setBits(bits);
  return value;
}

void put_half(std::byte*& out, std::uint16_t bits) {
  std::memcpy(out, &bits, sizeof bits);
  out += sizeof bits;
}

float take_half(const std::byte*& record) {
  std::uint16_t bits;
  std::memcpy(&bits, record, sizeof bits);
  record += sizeof bits;
  return half_value(bits);
}

// An opacity that can be seen stays so, one that cannot becomes 0.
std::uint16_t half_opacity(float opacity) {
  constexpr float kLeast = 1 / kOpacityLevels;
  if (opacity < kLeast) return 0;
  const std::uint16_t bits = half_bits(opacity);
  return half_value(bits) < kLeast ? static_cast<std::uint16_t>(bits + 1) : bits;
}

DecodedGaussian decode_half(const FirstHalf& first, const std::byte* record, int sh_degree) {
  DecodedGaussian out{};
  Gaussian<float>& g = out.gaussian;
  g.mean = first.mean;
  // The third is for both signs set, which no axis has: whoever restores a scene refuses NaN.
  const float others[3] = {take_half(record), take_half(record), NAN};
  const int axis = (std::signbit(others[0]) ? 1 : 0) | (std::signbit(others[1]) ? 2 : 0);
  for (int k = 0, other = 0; k < 3; ++k) {
    g.scale[k] = k == axis ? first.scale_max : first.scale_max * std::abs(others[other++]);
  }
  // Sixteen bits leave a length off by 10^-3, and the coarse filter counts on a rotation.
  float squared = 0;
  for (float& component : g.quat) {
    component = take_half(record);
    squared += component * component;
  }
  const float length = std::sqrt(squared);
  for (float& component : g.quat) component = component / length;
  g.opacity = take_half(record);
  for (int k = 0; k < sh_coeff_count(sh_degree); ++k) {
    for (int channel = 0; channel < 3; ++channel) out.sh[k][channel] = take_half(record);
  }
  return out;
}

DecodedGaussian decode_quantised(const SecondHalfFormat& format, const FirstHalf& first,
                                 const std::byte* record, const std::byte* codebooks) {
  const CodebookIndices indices = decode_indices(format, record);
  const auto read = [&](Codebook codebook, void* into) {
    const EntryRange range = format.entry(codebook, indices[static_cast<std::size_t>(codebook)]);
    std::memcpy(into, codebooks + range.begin, range.bytes);
  };
  DecodedGaussian out{};
  Gaussian<float>& g = out.gaussian;
  g.mean = first.mean;
  float ratios[3];
  read(Codebook::kScale, ratios);
  for (int k = 0; k < 3; ++k) g.scale[k] = first.scale_max * ratios[k];
  read(Codebook::kRotation, g.quat.data());
  read(Codebook::kDc, &out.sh[0]);
  if (format.sh_degree > 0) read(Codebook::kSh, &out.sh[1]);
  const std::byte opacity =
      record[format.encoding == SecondHalfEncoding::kVq ? format.bytes() - 1 : 0];
  g.opacity = static_cast<float>(std::to_integer<int>(opacity)) / kOpacityLevels;
  return out;
}

template <class OfCodebook>
void for_each_codebook(OfCodebook&& of_codebook) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) of_codebook(static_cast<Codebook>(id), id);
}

}  // namespace

std::uint32_t SecondHalfFormat::index_bits(Codebook codebook) const {
  std::uint32_t bits = 0;
  while ((std::uint64_t{1} << bits) < entries[static_cast<std::size_t>(codebook)]) ++bits;
  return bits;
}

std::uint32_t SecondHalfFormat::bytes() const {
  if (encoding == SecondHalfEncoding::kRaw) return raw_second_half_bytes(sh_degree);
  if (encoding == SecondHalfEncoding::kHalf) return raw_second_half_bytes(sh_degree) / 2;
  std::uint32_t indices = 0, bits = 0;
  for_each_codebook([&](Codebook codebook, std::size_t) {
    bits += index_bits(codebook);
    indices += index_bits(codebook) > 0 ? 1 : 0;
  });
  if (encoding == SecondHalfEncoding::kVq) return kIndexBytes * indices + 1;
  const std::uint32_t needed = 1 + (bits + 7) / 8;
  std::uint32_t power = 1;
  while (power < needed) power *= 2;
  return power;
}

std::uint32_t SecondHalfFormat::codebook_begin(std::size_t codebook) const {
  std::uint32_t begin = 0;
  for (std::size_t id = 0; id < codebook; ++id) {
    begin += entries[id] * entry_bytes(static_cast<Codebook>(id));
  }
  return begin;
}

void encode_half_second_half(const Gaussian<float>& g, const glm::vec3* sh, int sh_degree,
                             std::byte* out) {
  const int axis = largest_axis(g.scale);
  for (int k = 0, other = 0; k < 3; ++k) {
    if (k == axis) continue;
    const float ratio = g.scale[axis] > 0 ? g.scale[k] / g.scale[axis] : 0;
    put_half(out, half_bits(std::copysign(ratio, (axis >> other & 1) != 0 ? -1.0F : 1.0F)));
    ++other;
  }
  for (const float component : g.quat) put_half(out, half_bits(component));
  put_half(out, half_opacity(g.opacity));
  for (int k = 0; k < sh_coeff_count(sh_degree); ++k) {
    for (int channel = 0; channel < 3; ++channel) put_half(out, half_bits(sh[k][channel]));
  }
}

void encode_quantised_second_half(const SecondHalfFormat& format, const CodebookIndices& indices,
                                  std::uint8_t opacity, std::byte* out) {
  if (format.encoding == SecondHalfEncoding::kVq) {
    for_each_codebook([&](Codebook codebook, std::size_t id) {
      if (format.index_bits(codebook) == 0) return;
      std::memcpy(out, &indices[id], kIndexBytes);
      out += kIndexBytes;
    });
    *out = std::byte{opacity};
    return;
  }
  std::uint64_t packed = 0;
  std::uint32_t at = 0;
  for_each_codebook([&](Codebook codebook, std::size_t id) {
    if (format.index_bits(codebook) == 0) return;
    packed |= std::uint64_t{indices[id]} << at;
    at += format.index_bits(codebook);
  });
  out[0] = std::byte{opacity};
  for (std::uint32_t b = 1; b < format.bytes(); ++b) {
    out[b] = b <= 8 ? static_cast<std::byte>(packed >> (8 * (b - 1)) & 0xff) : std::byte{0};
  }
}

CodebookIndices decode_indices(const SecondHalfFormat& format, const std::byte* record) {
  CodebookIndices indices{};
  if (format.encoding == SecondHalfEncoding::kVq) {
    for_each_codebook([&](Codebook codebook, std::size_t id) {
      if (format.index_bits(codebook) == 0) return;
      std::memcpy(&indices[id], record, kIndexBytes);
      record += kIndexBytes;
    });
    return indices;
  }
  std::uint64_t packed = 0;
  for (std::uint32_t b = 1; b < std::min(format.bytes(), 9U); ++b) {
    packed |= std::uint64_t{std::to_integer<std::uint8_t>(record[b])} << (8 * (b - 1));
  }
  for_each_codebook([&](Codebook codebook, std::size_t id) {
    const std::uint32_t bits = format.index_bits(codebook);
    if (bits == 0) return;
    indices[id] = static_cast<std::uint32_t>(packed & ((std::uint64_t{1} << bits) - 1));
    packed >>= bits;
  });
  return indices;
}

DecodedGaussian decode_second_half(const SecondHalfFormat& format, const FirstHalf& first,
                                   const std::byte* record, const std::byte* codebooks) {
  switch (format.encoding) {
    case SecondHalfEncoding::kRaw:
      return decode_raw_second_half(first, record, format.sh_degree);
    case SecondHalfEncoding::kHalf:
      return decode_half(first, record, format.sh_degree);
    default:
      return decode_quantised(format, first, record, codebooks);
  }
}

}  // namespace sgs
