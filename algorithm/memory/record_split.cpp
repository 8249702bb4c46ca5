// The splits, and the two ways through them.
#include "algorithm/memory/record_split.h"

#include <algorithm>
#include <cstring>

#include "algorithm/memory/records.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

constexpr std::uint32_t kWordBytes = 4;
constexpr std::uint32_t kBurstBytes = 32;

// [carried words][second half]
using Payload = std::array<std::byte, kWordBytes + kMaxSecondHalfBytes>;

// Places in a raw payload with a short quaternion, in words.
constexpr std::size_t kScaleWord = 0, kQuaternionWord = 3, kOpacityWord = 6, kShWord = 7;
constexpr std::uint32_t kRawShByte = 28;  // place in a raw second half

// Bits that are nought whatever the Gaussian.
struct SpareBit {
  std::size_t word;
  unsigned bit;
};
constexpr std::array<SpareBit, 8> kSpareBits = {
    {{0, 31}, {1, 31}, {2, 31}, {3, 30}, {4, 30}, {5, 30}, {6, 30}, {6, 31}}};

std::uint32_t word_at(const Payload& payload, std::size_t word) {
  std::uint32_t value;
  std::memcpy(&value, payload.data() + kWordBytes * word, kWordBytes);
  return value;
}

void put_word(Payload& payload, std::size_t word, std::uint32_t value) {
  std::memcpy(payload.data() + kWordBytes * word, &value, kWordBytes);
}

std::uint32_t bits_of(float value) { return __builtin_bit_cast(std::uint32_t, value); }
float float_of(std::uint32_t bits) { return __builtin_bit_cast(float, bits); }

std::uint32_t sh_bytes(int sh_degree) {
  return 3 * kWordBytes * static_cast<std::uint32_t>(sh_coeff_count(sh_degree));
}

Payload payload_of(const SecondHalfFormat& format, const Gaussian<float>& g,
                   const std::byte* encoded) {
  Payload payload{};
  put_word(payload, 0, bits_of(g.scale[largest_axis(g.scale)]));
  std::memcpy(payload.data() + kWordBytes, encoded, format.bytes());
  return payload;
}

Payload short_payload_of(const SecondHalfFormat& format, const Gaussian<float>& g,
                         const std::byte* encoded) {
  Payload payload{};
  const ShortQuaternion quat = shorten(g.quat);
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    put_word(payload, kScaleWord + at, bits_of(g.scale[k]));
    put_word(payload, kQuaternionWord + at, bits_of(quat.others[at]));
  }
  put_word(payload, kOpacityWord, bits_of(g.opacity));
  for (std::size_t k = 0; k < kSpareBits.size(); ++k) {
    const SpareBit spare = kSpareBits[k];
    const std::uint32_t bit = (quat.rest >> k & 1U) << spare.bit;
    put_word(payload, spare.word, word_at(payload, spare.word) | bit);
  }
  std::memcpy(payload.data() + kWordBytes * kShWord, encoded + kRawShByte,
              sh_bytes(format.sh_degree));
  return payload;
}

Payload joined(const RecordSplit& split, const CarriedWords& carried, const std::byte* second) {
  Payload payload{};
  const std::size_t in_front = kWordBytes * split.carried_words;
  std::memcpy(payload.data(), carried.data(), in_front);
  std::memcpy(payload.data() + in_front, second,
              std::min<std::size_t>(split.second_bytes, payload.size() - in_front));
  return payload;
}

DecodedGaussian read_short(Payload payload, int sh_degree, const glm::vec3& mean) {
  ShortQuaternion quat;
  for (std::size_t k = 0; k < kSpareBits.size(); ++k) {
    const SpareBit spare = kSpareBits[k];
    const std::uint32_t word = word_at(payload, spare.word);
    quat.rest = static_cast<std::uint8_t>(quat.rest | (word >> spare.bit & 1U) << k);
    put_word(payload, spare.word, word & ~(1U << spare.bit));
  }
  DecodedGaussian out{};
  out.gaussian.mean = mean;
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out.gaussian.scale[k] = float_of(word_at(payload, kScaleWord + at));
    quat.others[at] = float_of(word_at(payload, kQuaternionWord + at));
  }
  out.gaussian.quat = lengthen(quat);
  out.gaussian.opacity = float_of(word_at(payload, kOpacityWord));
  std::memcpy(static_cast<void*>(out.sh), payload.data() + kWordBytes * kShWord,
              sh_bytes(sh_degree));
  return out;
}

std::uint32_t next_power_of_two(std::uint32_t bytes) {
  std::uint32_t power = 1;
  while (power < bytes) power *= 2;
  return power;
}

}  // namespace

RecordSplit published_split(const SecondHalfFormat& format) {
  return {CoarseBoundBy::kLargestScale, 1, false, format.bytes()};
}

RecordSplit burst_split(const SecondHalfFormat& format) {
  constexpr RecordSplit kRaw[] = {{CoarseBoundBy::kExtents, 2, true, kBurstBytes},
                                  {CoarseBoundBy::kExtents, 0, false, 80},
                                  {CoarseBoundBy::kExtents, 2, true, 4 * kBurstBytes},
                                  {CoarseBoundBy::kExtents, 0, false, 7 * kBurstBytes}};
  constexpr std::uint32_t kHalfBytes[] = {kBurstBytes, 48, 72, 4 * kBurstBytes};
  switch (format.encoding) {
    case SecondHalfEncoding::kRaw:
      return kRaw[format.sh_degree];
    case SecondHalfEncoding::kHalf:
      return {CoarseBoundBy::kExtents, 0, false, kHalfBytes[format.sh_degree]};
    default:
      return {CoarseBoundBy::kExtents, 0, false, next_power_of_two(kWordBytes + format.bytes())};
  }
}

void write_record(const RecordSplit& split, const SecondHalfFormat& format,
                  const Gaussian<float>& g, const std::byte* encoded, std::byte* first,
                  std::byte* second) {
  const Payload payload = split.short_quaternion ? short_payload_of(format, g, encoded)
                                                 : payload_of(format, g, encoded);
  for (int k = 0; k < 3; ++k, first += kWordBytes) std::memcpy(first, &g.mean[k], kWordBytes);
  if (split.bound_by == CoarseBoundBy::kExtents) {
    const ExtentCode code = encode_extents(visible_extents(g));
    std::memcpy(first, &code, sizeof code);
    first += sizeof code;
  }
  const std::size_t in_front = kWordBytes * split.carried_words;
  std::memcpy(first, payload.data(), in_front);
  const std::size_t behind = std::min<std::size_t>(split.second_bytes, payload.size() - in_front);
  std::memcpy(second, payload.data() + in_front, behind);
  std::fill(second + behind, second + split.second_bytes, std::byte{0});
}

SplitFirstHalf read_first_half(const RecordSplit& split, const std::byte* first) {
  SplitFirstHalf out{};
  for (int k = 0; k < 3; ++k, first += kWordBytes) std::memcpy(&out.mean[k], first, kWordBytes);
  if (split.bound_by == CoarseBoundBy::kExtents) {
    ExtentCode code;
    std::memcpy(&code, first, sizeof code);
    out.extents = decode_extents(code);
    first += sizeof code;
  }
  std::memcpy(out.carried.data(), first, kWordBytes * split.carried_words);
  if (split.bound_by == CoarseBoundBy::kLargestScale) {
    out.extents.scale_max = float_of(out.carried[0]);
  }
  return out;
}

DecodedGaussian read_record(const RecordSplit& split, const SecondHalfFormat& format,
                            const glm::vec3& mean, const CarriedWords& carried,
                            const std::byte* second, const std::byte* codebooks) {
  const Payload payload = joined(split, carried, second);
  if (split.short_quaternion) return read_short(payload, format.sh_degree, mean);
  return decode_second_half(format, {mean, float_of(word_at(payload, 0))},
                            payload.data() + kWordBytes, codebooks);
}

CodebookIndices read_indices(const RecordSplit& split, const SecondHalfFormat& format,
                             const CarriedWords& carried, const std::byte* second) {
  return decode_indices(format, joined(split, carried, second).data() + kWordBytes);
}

FirstHalfBound bound_first_half(const RecordSplit& split, const SplitFirstHalf& first,
                                const View<float>& view) {
  const VisibleExtents& known = first.extents;
  if (split.bound_by == CoarseBoundBy::kLargestScale) {
    return coarse_bound(view, first.mean, known.scale_max);
  }
  return extent_bound(view, first.mean, known.extent, known.scale_max);
}

}  // namespace sgs
