// The bytes of a Gaussian are divided between its first half, which the coarse filter reads of
// every Gaussian of a block, and its second half, which is fetched of those that pass.
//
// A second half in its encoding (second_half.h) with the largest scale in front of it is the
// payload. The first half holds x, y, z, then (by extents) the code of the visible extents, then
// the first words of the payload; the second half holds the rest.
//   published   the paper's halves: x, y, z and the largest scale; the second half as encoded.
//   by bursts   for storage by chunks, and by file where first halves stay as short. Second halves
//               are fetched one here, one there, and a burst is moved whole: what counts is how
//               many bursts of 32 B a record touches. Each takes whole bursts, or a power of two
//               below one. From the table, in bytes:
//
//     encoding, degree  published     by bursts  why
//     raw 0             16 + 40 (64)  24 + 32    56 B with extents: one word of the quaternion is
//                                                left out, two words go to the first half
//     raw 1             16 + 76 (104) 16 + 80 (96)   96 = 16 + 80 with nothing left out; 28 + 64
//                                                would save 32 for 12 B more in every first half
//                                                and in every key that waits
//     raw 2             16 + 136 (160) 24 + 128  as degree 0
//     raw 3             16 + 220 (248) 16 + 224  seven bursts without any art
//     half 0, 1, 2, 3   16 + 20 .. 110           32, 48, 72, 128: padded where that saves bursts
//     vq, vq_packed     16 + 17, 8               32, 16: the next power of two
//
// (in brackets: bytes on the bus, the mean over the places at which such a record may begin). Where
// a word of the quaternion is left out (records.h), the payload is the scales in their
// order, three words of the quaternion, the opacity and the SH coefficients. The 8 bits that bring
// the fourth word back are kept where bits of these are nought: the signs of scales and opacity,
// and the upper exponent bit of what does not exceed 1. All of it comes back to the bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <variant>

#include "algorithm/memory/second_half.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/visible_extents.h"

namespace sgs {

// The properties of a Gaussian's record that decide how much the fine filter computes.
struct FineRecord {
  int sh_degree = 0;
  std::uint32_t quaternion_words = 4;  // 3: the largest component follows from the others

  friend constexpr bool operator==(const FineRecord& a, const FineRecord& b) {
    return a.sh_degree == b.sh_degree && a.quaternion_words == b.quaternion_words;
  }
};

struct RecordSplit {
  CoarseBoundBy bound_by = CoarseBoundBy::kLargestScale;  // bound that tests the first half
  std::uint32_t carried_words = 1;                        // words of the payload in the first half
  bool short_quaternion = false;                          // three words of four are stored
  std::uint32_t second_bytes = 0;

  FineRecord fine_record(int sh_degree) const { return {sh_degree, short_quaternion ? 3U : 4U}; }
  std::uint32_t first_bytes() const {
    return 12 + (bound_by == CoarseBoundBy::kExtents ? 4 : 0) + 4 * carried_words;
  }
};

RecordSplit published_split(const SecondHalfFormat& format);
RecordSplit burst_split(const SecondHalfFormat& format);

// Words of the payload in a first half: they wait with its key until the second half comes.
constexpr std::size_t kMostCarriedWords = 2;
using CarriedWords = std::array<std::uint32_t, kMostCarriedWords>;

// A first half as it is read.
struct SplitFirstHalf {
  glm::vec3 mean;
  VisibleExtents extents;  // by the largest scale: that alone
  CarriedWords carried{};
};

// encoded: the second half, format.bytes() bytes, of this Gaussian, as its decoder sees it. Writes
// split.first_bytes() and split.second_bytes. With a short quaternion it must be of unit length to
// a few units in the last place; throws std::invalid_argument where it is not.
void write_record(const RecordSplit& split, const SecondHalfFormat& format,
                  const Gaussian<float>& g, const std::byte* encoded, std::byte* first,
                  std::byte* second);

SplitFirstHalf read_first_half(const RecordSplit& split, const std::byte* first);

// codebooks: as decode_second_half() takes them.
DecodedGaussian read_record(const RecordSplit& split, const SecondHalfFormat& format,
                            const glm::vec3& mean, const CarriedWords& carried,
                            const std::byte* second, const std::byte* codebooks);

// The indices of a quantised record.
CodebookIndices read_indices(const RecordSplit& split, const SecondHalfFormat& format,
                             const CarriedWords& carried, const std::byte* second);

// The coarse test of a first half, whatever it is bounded by: its part that is the same for all
// rectangles.
using FirstHalfBound = std::variant<CoarseBound, ExtentBound>;

FirstHalfBound bound_first_half(const RecordSplit& split, const SplitFirstHalf& first,
                                const View<float>& view);

// The depth v_z of its centre, world units.
inline float depth_of(const FirstHalfBound& bound) {
  return std::visit([](const auto& of) { return of.depth; }, bound);
}

// false: behind the near plane, or no pixel of the rectangle can change.
inline bool touches(const FirstHalfBound& bound, const PixelRect& pixels) {
  return std::visit([&](const auto& of) { return of.in_front && touches(of, pixels); }, bound);
}

}  // namespace sgs
