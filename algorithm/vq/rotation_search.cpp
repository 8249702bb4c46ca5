// Leaves of entries behind each other, of which most are too far off as a whole.
#include "algorithm/vq/rotation_search.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>
#include <limits>
#include <numeric>

#include "algorithm/splat/widest_lanes.h"

namespace sgs {
namespace {

constexpr std::size_t kLeaf = RotationSearch::kLeaf;
constexpr int kFactors[kMonomials][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                         {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// A point's quaternion q and q i, q j, q k: the entry q' is off by the turn whose half angle's sine
// has the components q' . q i, q' . q j, q' . q k about the ellipsoid's own axes.
using Frame = std::array<glm::dvec4, 4>;
Frame frame_of(const float* q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {glm::dvec4(w, x, y, z), glm::dvec4(-x, w, z, -y), glm::dvec4(-y, -z, w, x),
          glm::dvec4(-z, y, -x, w)};
}

// Which of the frame's four play the turns about axes 0, 1, 2 after each half turn.
constexpr std::size_t kTurns[4][3] = {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}};

bool before(const RotationMatch& a, const RotationMatch& b) {
  if (a.cost != b.cost) return a.cost < b.cost;
  return a.entry != b.entry ? a.entry < b.entry : a.half_turn < b.half_turn;
}

// [lane] costs of kLeaf entries whose monomials stand side by side.
[[gnu::always_inline]] inline void costs_of(const Monomials& coefficients, const float* monomials,
                                            float* costs) {
  for (std::size_t lane = 0; lane < kLeaf; ++lane) {
    float cost = 0;
    for (std::size_t m = 0; m < kMonomials; ++m) {
      cost += coefficients[m] * monomials[m * kLeaf + lane];
    }
    costs[lane] = cost;
  }
}

// More than a computed cost can be off: the absolute values of its ten products add up to 1 at
// most, and 13 roundings of half a last place of 1 are 8e-7.
constexpr float kRounding = 2e-6F;

struct Turned {
  Monomials coefficients;
  float root_share;  // root of the largest share
  std::size_t half_turn;
};

[[gnu::always_inline]] inline void compare_leaf(const RotationSearch::Leaves& leaves,
                                                std::size_t leaf, const Turned& point,
                                                RotationMatch& best) {
  float costs[kLeaf];
  costs_of(point.coefficients, &leaves.monomials[leaf * kMonomials * kLeaf], costs);
  std::int32_t any = 0;
  for (std::size_t lane = 0; lane < kLeaf; ++lane) any |= costs[lane] <= best.cost ? 1 : 0;
  if (any == 0) return;
  for (std::size_t lane = 0; lane < kLeaf; ++lane) {
    const RotationMatch match{leaves.entries[leaf * kLeaf + lane], point.half_turn, costs[lane]};
    if (before(match, best)) best = match;
  }
}

// A leaf whose centre costs more has no entry whose computed cost is as low as the best.
// root_best: of the best cost, with room for an entry's rounding.
[[gnu::always_inline]] inline float bound_of(float root_best, float radius, const Turned& point) {
  const float root = root_best + radius * point.root_share;
  return root * root + kRounding;
}
float root_of(const RotationMatch& best) {
  return std::sqrt(std::max(0.0F, best.cost) + kRounding);
}

// The place of the least of some whole lanes of costs; lane by lane, with masks for selections.
[[gnu::always_inline]] inline std::size_t least_of(const float* costs, std::size_t count) {
  float least[kLeaf];
  std::int32_t place[kLeaf];
  for (std::size_t lane = 0; lane < kLeaf; ++lane) {
    least[lane] = costs[lane];
    place[lane] = static_cast<std::int32_t>(lane);
  }
  for (std::size_t at = kLeaf; at < count; at += kLeaf) {
    for (std::size_t lane = 0; lane < kLeaf; ++lane) {
      const std::int32_t less = -static_cast<std::int32_t>(costs[at + lane] < least[lane]);
      place[lane] = (static_cast<std::int32_t>(at + lane) & less) | (place[lane] & ~less);
      least[lane] = std::min(least[lane], costs[at + lane]);
    }
  }
  const auto lane = static_cast<std::size_t>(std::min_element(least, least + kLeaf) - least);
  return static_cast<std::size_t>(place[lane]);
}

// Leaves are looked at so many at a time: first the one whose centre costs least.
constexpr std::size_t kRun = 256;

SGS_WIDEST_LANES
void compare_run(const RotationSearch::Leaves& leaves, std::size_t first, std::size_t count,
                 const Turned& point, RotationMatch& best) {
  float centre[kRun] = {};
  std::int32_t far[kRun];
  const std::size_t padded = (count + kLeaf - 1) / kLeaf * kLeaf;
  for (std::size_t leaf = 0; leaf < padded; leaf += kLeaf) {
    costs_of(point.coefficients, &leaves.centres[(first + leaf) * kMonomials], centre + leaf);
  }
  const std::size_t nearest = least_of(centre, padded);
  compare_leaf(leaves, first + nearest, point, best);
  float root_best = root_of(best);
  for (std::size_t leaf = 0; leaf < count; ++leaf) {
    far[leaf] = centre[leaf] > bound_of(root_best, leaves.radii[first + leaf], point) ? 1 : 0;
  }
  for (std::size_t leaf = 0; leaf < count; ++leaf) {
    if (far[leaf] != 0 || leaf == nearest) continue;
    if (centre[leaf] > bound_of(root_best, leaves.radii[first + leaf], point)) continue;
    compare_leaf(leaves, first + leaf, point, best);
    root_best = root_of(best);
  }
}

}  // namespace

glm::dmat4 rotation_cost(const float* point, std::size_t half_turn) {
  const Frame frame = frame_of(point);
  glm::dmat4 matrix(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const glm::dvec4& e = frame[kTurns[half_turn][axis]];
    matrix += static_cast<double>(point[kQuatDims + axis]) * glm::outerProduct(e, e);
  }
  return matrix;
}

bool near_border(const float* point, std::size_t half_turn) {
  constexpr float kNear = 0.6F;
  return half_turn == 0 || std::abs(point[half_turn]) > kNear * std::abs(point[0]);
}

Monomials monomials_of(const float* quat) {
  Monomials out;
  for (std::size_t m = 0; m < kMonomials; ++m) {
    out[m] = quat[kFactors[m][0]] * quat[kFactors[m][1]];
  }
  return out;
}

Monomials coefficients_of(const glm::dmat4& matrix) {
  Monomials out;
  for (std::size_t m = 0; m < kMonomials; ++m) {
    const int* factors = kFactors[m];
    const double twice = factors[0] == factors[1] ? 1 : 2;
    out[m] = static_cast<float>(twice * matrix[factors[0]][factors[1]]);
  }
  return out;
}

RotationSearch::RotationSearch(const std::vector<float>& quats) {
  std::vector<std::uint32_t> all(quats.size() / kQuatDims);
  std::iota(all.begin(), all.end(), 0U);
  build(quats, all.data(), all.size());
}

// Cuts along the widest axis, down to leaves that are full but for the last.
void RotationSearch::build(const std::vector<float>& quats, std::uint32_t* entries,
                           std::size_t count) {
  if (count <= kLeaf) {
    add_leaf(quats, entries, count);
    return;
  }
  const auto value = [&](std::uint32_t entry, std::size_t axis) {
    return quats[std::size_t{entry} * kQuatDims + axis];
  };
  std::size_t widest = 0;
  float width = -1;
  for (std::size_t axis = 0; axis < kQuatDims; ++axis) {
    const auto [low, high] = std::minmax_element(
        entries, entries + count,
        [&](std::uint32_t a, std::uint32_t b) { return value(a, axis) < value(b, axis); });
    if (value(*high, axis) - value(*low, axis) > width) {
      width = value(*high, axis) - value(*low, axis);
      widest = axis;
    }
  }
  const std::size_t half = (count / 2 + kLeaf - 1) / kLeaf * kLeaf;
  std::nth_element(entries, entries + half, entries + count, [&](std::uint32_t a, std::uint32_t b) {
    const float x = value(a, widest), y = value(b, widest);
    return x < y || (x == y && a < b);
  });
  build(quats, entries, half);
  build(quats, entries + half, count - half);
}

void RotationSearch::add_leaf(const std::vector<float>& quats, const std::uint32_t* entries,
                              std::size_t count) {
  const std::size_t leaf = leaves_.radii.size(), block = leaf / kLeaf * kLeaf;
  const auto quat = [&](std::size_t i) {
    return quats.data() + std::size_t{entries[i]} * kQuatDims;
  };
  const auto vector_of = [&](std::size_t i) {
    const float* q = quat(i);
    return glm::dvec4(q[0], q[1], q[2], q[3]);
  };
  leaves_.monomials.resize((leaf + 1) * kMonomials * kLeaf);
  leaves_.centres.resize((block + kLeaf) * kMonomials);
  glm::dvec4 centre(0.0);
  for (std::size_t i = 0; i < count; ++i) centre += vector_of(i) / static_cast<double>(count);
  double radius = 0;
  for (std::size_t lane = 0; lane < kLeaf; ++lane) {
    // Padded with the first, which never comes before itself.
    const std::size_t i = lane < count ? lane : 0;
    const Monomials monomials = monomials_of(quat(i));
    for (std::size_t m = 0; m < kMonomials; ++m) {
      leaves_.monomials[(leaf * kMonomials + m) * kLeaf + lane] = monomials[m];
    }
    leaves_.entries.push_back(entries[i]);
    radius = std::max(radius, glm::length(vector_of(i) - centre));
  }
  const float of_centre[kQuatDims] = {static_cast<float>(centre.x), static_cast<float>(centre.y),
                                      static_cast<float>(centre.z), static_cast<float>(centre.w)};
  const Monomials monomials = monomials_of(of_centre);
  for (std::size_t m = 0; m < kMonomials; ++m) {
    // Behind the last leaf stands the first of its block again, which is found before its copies.
    const auto lanes =
        leaves_.centres.begin() + static_cast<std::ptrdiff_t>(block * kMonomials + m * kLeaf);
    if (leaf == block) std::fill_n(lanes, kLeaf, monomials[m]);
    lanes[static_cast<std::ptrdiff_t>(leaf - block)] = monomials[m];
  }
  leaves_.radii.push_back(static_cast<float>(radius * (1 + 1e-5) + 1e-6));
}

RotationMatch RotationSearch::find(const float* point) const {
  const float* share = point + kQuatDims;
  const float root_share = std::sqrt(std::max({share[0], share[1], share[2]})) * (1 + 1e-5F);
  RotationMatch best{0, 0, std::numeric_limits<float>::infinity()};
  for (std::size_t half_turn = 0; half_turn < 4; ++half_turn) {
    if (!near_border(point, half_turn)) continue;
    const Turned of{coefficients_of(rotation_cost(point, half_turn)), root_share, half_turn};
    for (std::size_t first = 0; first < leaves_.radii.size(); first += kRun) {
      compare_run(leaves_, first, std::min(kRun, leaves_.radii.size() - first), of, best);
    }
  }
  return best;
}

}  // namespace sgs
