// A scene in one of the encodings: the bytes of its second halves, and what they decode to.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

// Every golden image of an encoded scene is of `decoded`: the Gaussians that the units get out of
// the bytes, to the bit.
struct EncodedCloud {
  SecondHalfFormat format;
  ActivatedCloud decoded;
  std::vector<std::byte> records;    // [N] second halves; empty with raw, where `decoded` says all
  std::vector<std::byte> codebooks;  // [format.codebook_bytes()]

  // Writes the second half of Gaussian `index`, format.bytes() bytes.
  void write_second_half(std::size_t index, std::byte* out) const;
};

// order: as in ../splat/gaussian.h.
EncodedCloud reordered(EncodedCloud encoded, const std::vector<std::uint32_t>& order);

EncodedCloud encode_raw(ActivatedCloud cloud);
EncodedCloud encode_half(const ActivatedCloud& cloud);
// encoding: kVq or kVqPacked. quantised: of this cloud.
EncodedCloud encode_quantised(const ActivatedCloud& cloud, const QuantisedCloud& quantised,
                              SecondHalfEncoding encoding);

}  // namespace sgs
