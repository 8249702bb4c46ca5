// Search for the entry of a codebook of rotations that costs an ellipsoid least.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

namespace sgs {

constexpr int kQuatDims = 4;
// A point of the search: a unit quaternion, and the share of each axis in its sensitivity to turns,
// not negative, together 1 or 0.
constexpr int kRotationDims = kQuatDims + 3;

struct RotationMatch {
  std::uint32_t entry = 0;
  std::size_t half_turn = 0;  // after which it costs that
  float cost = 0;
};

// The matrix whose quadratic form is the cost of an entry to a point, after a half turn about none
// (0) or one of the ellipsoid's own axes (1, 2, 3).
glm::dmat4 rotation_cost(const float* point, std::size_t half_turn);

// True if an entry could cost less after that half turn. Canonical quaternions have their largest
// component first, and a half turn about axis k puts component k there. Far from the border of the
// canonical domain there is no entry to be found across it.
bool near_border(const float* point, std::size_t half_turn);

// A quadratic form of four variables has ten coefficients, and a quaternion ten monomials.
constexpr std::size_t kMonomials = 10;
using Monomials = std::array<float, kMonomials>;
Monomials monomials_of(const float* quat);
Monomials coefficients_of(const glm::dmat4& matrix);

// The cost of an entry is their product, summed in that order.
class RotationSearch {
 public:
  // quats: [K, 4] of unit length, K > 0.
  explicit RotationSearch(const std::vector<float>& quats);

  // The entry that costs the point least; of equal ones the first, and its first half turn.
  RotationMatch find(const float* point) const;

  static constexpr std::size_t kLeaf = 16;  // compared side by side

  // Entries close to each other, kLeaf a leaf: the root of a cost, a seminorm, differs in a leaf
  // from its centre's by no more than the radius times the root of the largest share.
  struct Leaves {
    std::vector<float> monomials;        // [leaves, kMonomials, kLeaf]
    std::vector<std::uint32_t> entries;  // [leaves, kLeaf]
    std::vector<float> centres;          // [leaves / kLeaf, kMonomials, kLeaf], of the centres
    std::vector<float> radii;            // [leaves]
  };

 private:
  void build(const std::vector<float>& quats, std::uint32_t* entries, std::size_t count);
  void add_leaf(const std::vector<float>& quats, const std::uint32_t* entries, std::size_t count);

  Leaves leaves_;
};

}  // namespace sgs
