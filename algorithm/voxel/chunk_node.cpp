// Quantisation of chunk bounds.
#include "algorithm/voxel/chunk_node.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sgs {
namespace {

constexpr int kLevels = kMostExtent;

// Smallest power of two, as exponent, with origin + 255 steps >= high in float.
int step_exponent(float origin, float high) {
  const double width = std::max(0.0, static_cast<double>(high) - origin);
  int exponent = width > 0 ? std::ilogb(width / kLevels) : -126;
  exponent = std::clamp(exponent, -126, 127);
  while (exponent < 127 &&
         origin + static_cast<float>(kLevels) * std::ldexp(1.0F, exponent) < high) {
    ++exponent;
  }
  return exponent;
}

float position(float origin, int q, int exponent) {
  return box_bound(origin, std::ldexp(1.0F, exponent), q);
}

std::uint8_t quantise_low(float value, float origin, int exponent) {
  int q = static_cast<int>(std::clamp(
      std::floor((static_cast<double>(value) - origin) / std::ldexp(1.0, exponent)), 0.0, 255.0));
  while (q > 0 && position(origin, q, exponent) > value) --q;
  return static_cast<std::uint8_t>(q);
}

std::uint8_t quantise_high(float value, float origin, int exponent) {
  int q = static_cast<int>(std::clamp(
      std::ceil((static_cast<double>(value) - origin) / std::ldexp(1.0, exponent)), 0.0, 255.0));
  while (q < kLevels && position(origin, q, exponent) < value) ++q;
  return static_cast<std::uint8_t>(q);
}

float extent_of(int q, int exponent) {
  return extent_value<float>(q, least_extent_exponent(exponent));
}

std::uint8_t quantise_extent(float value, int exponent) {
  if (!(value > 0)) return 0;
  const double below = (exponent - std::log2(static_cast<double>(value))) * kExtentSteps;
  int q = kLevels - static_cast<int>(std::clamp(std::floor(below), 0.0, 255.0));
  while (q < kLevels && extent_of(q, exponent) < value) ++q;
  return static_cast<std::uint8_t>(q);
}

constexpr int kInfiniteExtent = 127;  // exponent that stands for "beyond float"

}  // namespace

float extent_fraction(int q) {
  static const auto table = [] {
    std::array<float, kExtentSteps> out{};
    for (int k = 0; k < kExtentSteps; ++k) {
      const double octaves = (kExtentSteps - 1 - k) / static_cast<double>(kExtentSteps);
      out[static_cast<std::size_t>(k)] =
          std::nextafter(static_cast<float>(std::exp2(-octaves)), 2.0F);
    }
    return out;
  }();
  return table[static_cast<std::size_t>(q % kExtentSteps)];
}

ChunkBound merged(const ChunkBound& a, const ChunkBound& b) {
  ChunkBound out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = std::min(a.low[k], b.low[k]);
    out.high[k] = std::max(a.high[k], b.high[k]);
    out.extent[k] = std::max(a.extent[k], b.extent[k]);
  }
  out.scale_max = std::max(a.scale_max, b.scale_max);
  return out;
}

void quantise(const ChunkBound* bounds, ChunkNode& node) {
  ChunkBound all = bounds[0];
  for (int c = 1; c < node.children; ++c) all = merged(all, bounds[c]);
  float largest = all.scale_max;
  for (int k = 0; k < 3; ++k) {
    node.origin[k] = all.low[k];
    node.step_exponent[k] = static_cast<std::int8_t>(step_exponent(all.low[k], all.high[k]));
    largest = std::max(largest, all.extent[k]);
  }
  const int octave = std::isfinite(largest) && largest > 0 ? std::ilogb(largest) + 1 : -100;
  node.extent_exponent = static_cast<std::int8_t>(
      std::isfinite(largest) ? std::clamp(octave, -100, kInfiniteExtent) : kInfiniteExtent);
  for (int c = 0; c < node.children; ++c) {
    for (int k = 0; k < 3; ++k) {
      node.low[c][k] = quantise_low(bounds[c].low[k], node.origin[k], node.step_exponent[k]);
      node.high[c][k] = quantise_high(bounds[c].high[k], node.origin[k], node.step_exponent[k]);
      node.extent[c][k] = quantise_extent(bounds[c].extent[k], node.extent_exponent);
    }
    node.scale[c] = quantise_extent(bounds[c].scale_max, node.extent_exponent);
  }
}

ChunkBound child_bound(const ChunkNode& node, int child) {
  const auto extent = [&](int q) {
    if (node.extent_exponent == kInfiniteExtent) return std::numeric_limits<float>::infinity();
    return extent_of(q, node.extent_exponent);
  };
  ChunkBound out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = position(node.origin[k], node.low[child][k], node.step_exponent[k]);
    out.high[k] = position(node.origin[k], node.high[child][k], node.step_exponent[k]);
    out.extent[k] = extent(node.extent[child][k]);
  }
  out.scale_max = extent(node.scale[child]);
  return out;
}

}  // namespace sgs
