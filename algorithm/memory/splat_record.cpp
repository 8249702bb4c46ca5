// Encoding and decoding of splats.
#include "algorithm/memory/splat_record.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace sgs {

void encode_splat(const Splat& s, const SubtileRect& group, std::byte* out) {
  const float words[10] = {s.x,       s.y,     s.conic_a, s.conic_b, s.conic_c,
                           s.opacity, s.depth, s.rgb.x,   s.rgb.y,   s.rgb.z};
  std::memcpy(out, words, sizeof words);
  std::memcpy(out + 40, &s.index, 4);
  const auto cut = [](int at, int low, int high) {
    return static_cast<std::byte>(std::clamp(at, low, high) - low);
  };
  out[44] = cut(s.footprint.x0, group.x0, group.x1);
  out[45] = cut(s.footprint.y0, group.y0, group.y1);
  out[46] = cut(s.footprint.x1, group.x0, group.x1);
  out[47] = cut(s.footprint.y1, group.y0, group.y1);
}

Splat decode_splat(const std::byte* bytes, const SubtileRect& group) {
  float words[10];
  std::memcpy(words, bytes, sizeof words);
  Splat s{};
  s.x = words[0];
  s.y = words[1];
  s.conic_a = words[2];
  s.conic_b = words[3];
  s.conic_c = words[4];
  s.opacity = words[5];
  s.depth = words[6];
  s.rgb = {words[7], words[8], words[9]};
  std::memcpy(&s.index, bytes + 40, 4);
  const auto at = [&](int byte, int low) {
    return static_cast<std::uint16_t>(low + std::to_integer<int>(bytes[byte]));
  };
  s.footprint = {at(44, group.x0), at(45, group.y0), at(46, group.x0), at(47, group.y0)};
  return s;
}

}  // namespace sgs
