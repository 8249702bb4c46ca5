// Which of the quaternions of an ellipsoid is meant.
#pragma once

#include <array>
#include <cmath>

namespace sgs {

using Quaternion = std::array<float, 4>;  // w, x, y, z

// Of the quaternions that name the same ellipsoid with its axes in this order, the one nearest to
// an entry: q, q i, q j and q k, either sign.
inline Quaternion nearest_name(const Quaternion& q, const float* entry) {
  const Quaternion names[4] = {{q[0], q[1], q[2], q[3]},
                               {-q[1], q[0], q[3], -q[2]},
                               {-q[2], -q[3], q[0], q[1]},
                               {-q[3], q[2], -q[1], q[0]}};
  const auto along = [&](const Quaternion& name) {
    return name[0] * entry[0] + name[1] * entry[1] + name[2] * entry[2] + name[3] * entry[3];
  };
  Quaternion best = names[0];
  for (const Quaternion& name : names) {
    if (std::abs(along(name)) > std::abs(along(best))) best = name;
  }
  if (along(best) < 0) {
    for (float& part : best) part = -part;
  }
  return best;
}

}  // namespace sgs
