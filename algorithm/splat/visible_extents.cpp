// Extents in float, and their levels.
#include "algorithm/splat/visible_extents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "algorithm/splat/footprint.h"

namespace sgs {
namespace {

constexpr int kLevelsPerOctave = 16;
constexpr int kLevelsPerScaleCode = 2;
constexpr int kSmallestScaleLevel = -8 * kLevelsPerOctave;
constexpr int kReachLevels = 28;  // 2^(28/16) = 3.364, no less than k sqrt(Sigma_aa) / scale_max
constexpr int kMostCode = 255;
constexpr int kInfiniteScale = 255;
constexpr int kLowestLevel = kSmallestScaleLevel + kReachLevels - kMostCode;
constexpr int kHighestLevel = kSmallestScaleLevel + kLevelsPerScaleCode * kMostCode + kReachLevels;

// 2^(level / 16), rounded up: 16 fractions in hardware, all levels here.
float level_value(int level) {
  static const auto values = [] {
    std::array<float, kHighestLevel - kLowestLevel + 1> out{};
    for (int l = kLowestLevel; l <= kHighestLevel; ++l) {
      const auto exact = std::exp2(l / static_cast<double>(kLevelsPerOctave));
      out[static_cast<std::size_t>(l - kLowestLevel)] =
          std::nextafter(static_cast<float>(exact), std::numeric_limits<float>::max());
    }
    return out;
  }();
  return values[static_cast<std::size_t>(level - kLowestLevel)];
}

float scale_value(int code) {
  return level_value(kSmallestScaleLevel + kLevelsPerScaleCode * code);
}

int highest_level(int scale_code) {
  return kSmallestScaleLevel + kLevelsPerScaleCode * scale_code + kReachLevels;
}

// Levels from 2^0 to the value, as a real number.
double levels_of(float value) { return kLevelsPerOctave * std::log2(static_cast<double>(value)); }

int code_at_least(double code) {
  return static_cast<int>(std::clamp(std::ceil(code), 0.0, static_cast<double>(kMostCode)));
}

std::uint8_t encode_scale(float scale_max) {
  if (!(scale_max > 0)) return 0;
  int code = code_at_least((levels_of(scale_max) - kSmallestScaleLevel) / kLevelsPerScaleCode - 1);
  while (code < kInfiniteScale && scale_value(code) < scale_max) ++code;
  return static_cast<std::uint8_t>(code);
}

std::uint8_t encode_below(int highest, float extent) {
  if (!(extent > 0)) return kMostCode;
  int below = code_at_least(highest - levels_of(extent));
  while (below > 0 && level_value(highest - below) < extent) --below;
  return static_cast<std::uint8_t>(below);
}

}  // namespace

VisibleExtents visible_extents(const Gaussian<float>& g) {
  float rotation[3][3];
  rotation_rows(g.quat, rotation);
  const float k = std::sqrt(std::max(0.0F, visible_cutoff(g.opacity)));
  constexpr float kRoundedUp = 1.00001F;
  VisibleExtents out;
  for (int a = 0; a < 3; ++a) {
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float m = rotation[a][axis] * g.scale[axis];
      sum += m * m;
    }
    // Beyond float the square overflows where the length does not.
    out.extent[a] = std::isfinite(sum) ? k * std::sqrt(sum) * kRoundedUp
                                       : std::numeric_limits<float>::infinity();
    out.scale_max = std::max(out.scale_max, g.scale[a]);
  }
  return out;
}

ExtentCode encode_extents(const VisibleExtents& extents) {
  ExtentCode code;
  code.scale = encode_scale(extents.scale_max);
  for (int a = 0; a < 3; ++a) {
    code.below[a] = encode_below(highest_level(code.scale), extents.extent[a]);
  }
  return code;
}

VisibleExtents decode_extents(const ExtentCode& code) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (code.scale == kInfiniteScale) return {glm::vec3(kInfinity), kInfinity};
  VisibleExtents out;
  out.scale_max = scale_value(code.scale);
  for (int a = 0; a < 3; ++a) {
    out.extent[a] = level_value(highest_level(code.scale) - code.below[a]);
  }
  return out;
}

}  // namespace sgs
