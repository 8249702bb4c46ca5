// Second halves in each of their encodings: how many bytes, how written, how read back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "algorithm/memory/records.h"

namespace sgs {

enum class Codebook : std::uint8_t { kScale, kRotation, kDc, kSh };
constexpr std::size_t kCodebookCount = 4;
constexpr std::array<const char*, kCodebookCount> kCodebookNames = {"scale", "rotation", "dc",
                                                                    "sh"};

constexpr std::uint32_t kMaxCodebookEntries = 1U << 16;

// Words (floats) of an entry. Scale: ratios to the largest, falling, the first 1. Rotation: unit
// quaternion (w, x, y, z). DC: rgb. SH: the higher bands, rgb each; none at degree 0.
constexpr std::uint32_t codebook_words(Codebook codebook, int sh_degree) {
  switch (codebook) {
    case Codebook::kScale:
      return 3;
    case Codebook::kRotation:
      return 4;
    case Codebook::kDc:
      return 3;
    default:
      return 3 * static_cast<std::uint32_t>((sh_degree + 1) * (sh_degree + 1) - 1);
  }
}

// An entry of each codebook.
using CodebookIndices = std::array<std::uint32_t, kCodebookCount>;

// How the codebooks of a scene are made.
struct VqConfig {
  std::uint32_t scale_entries = 4096;
  std::uint32_t rotation_entries = 4096;
  std::uint32_t dc_entries = 4096;
  std::uint32_t sh_entries = 512;
  std::uint32_t iterations = 20;
  std::uint64_t seed = 1;

  std::uint32_t entries(Codebook codebook) const {
    const std::uint32_t all[kCodebookCount] = {scale_entries, rotation_entries, dc_entries,
                                               sh_entries};
    return all[static_cast<std::size_t>(codebook)];
  }
};

// Its keys, for a visitor as modules/config has.
template <class Visitor>
void visit(Visitor& v, VqConfig& c) {
  constexpr std::uint32_t kMost = kMaxCodebookEntries;
  v("scale_entries", c.scale_entries, {1, kMost}, "most entries of the scale codebook");
  v("rotation_entries", c.rotation_entries, {1, kMost}, "of the rotation codebook");
  v("dc_entries", c.dc_entries, {1, kMost}, "of the codebook of base colours");
  v("sh_entries", c.sh_entries, {1, kMost}, "of the codebook of the higher bands");
  v("iterations", c.iterations, {0, 1000}, "of k-means, at most");
  v("seed", c.seed, {0, INT64_MAX}, "of k-means");
}

enum class SecondHalfEncoding : std::uint8_t {
  kRaw,   // 32-bit floats: records.h
  kHalf,  // 16-bit floats: ratios of the two other scales to the largest (signs: the axis of the
          // largest, as in records.h), quaternion, opacity, SH
  kVq,    // 32-bit indices into codebooks, 8-bit opacity
  kVqPacked,  // 8-bit opacity, then the indices in as many bits as they need, in 1, 2, 4, 8 or 16 B
};

constexpr std::array<const char*, 4> kEncodingNames = {"raw", "half", "vq", "vq_packed"};

// Where an entry lies among the codebooks' bytes.
struct EntryRange {
  std::uint32_t begin = 0, bytes = 0;
};

struct SecondHalfFormat {
  SecondHalfEncoding encoding = SecondHalfEncoding::kRaw;
  int sh_degree = 0;
  std::array<std::uint32_t, kCodebookCount> entries{};  // [codebook]; 0: there is none

  bool quantised() const {
    return encoding == SecondHalfEncoding::kVq || encoding == SecondHalfEncoding::kVqPacked;
  }
  // Bytes of one record. kVqPacked takes a power of two, so that none crosses a burst of the
  // memory: two bursts for one record cost more than the bytes that closer packing saves.
  std::uint32_t bytes() const;
  // Bits that tell the entries of a codebook apart: none where there is only one.
  std::uint32_t index_bits(Codebook codebook) const;
  std::uint32_t entry_bytes(Codebook codebook) const {
    return codebook_words(codebook, sh_degree) * static_cast<std::uint32_t>(sizeof(float));
  }
  // All codebooks lie one behind the other in the order of `Codebook`.
  std::uint32_t codebook_bytes() const { return codebook_begin(kCodebookCount); }
  EntryRange entry(Codebook codebook, std::uint32_t index) const {
    return {codebook_begin(static_cast<std::size_t>(codebook)) + index * entry_bytes(codebook),
            entry_bytes(codebook)};
  }

 private:
  std::uint32_t codebook_begin(std::size_t codebook) const;
};

// Each writes format.bytes() bytes.
void encode_half_second_half(const Gaussian<float>& g, const glm::vec3* sh, int sh_degree,
                             std::byte* out);
void encode_quantised_second_half(const SecondHalfFormat& format, const CodebookIndices& indices,
                                  std::uint8_t opacity, std::byte* out);

// The indices of a quantised record; 0 for a codebook without index.
CodebookIndices decode_indices(const SecondHalfFormat& format, const std::byte* record);

// codebooks: codebook_bytes() bytes; not looked at where the format has none. The largest scale is
// the first half's, to the bit.
DecodedGaussian decode_second_half(const SecondHalfFormat& format, const FirstHalf& first,
                                   const std::byte* record, const std::byte* codebooks);

}  // namespace sgs
