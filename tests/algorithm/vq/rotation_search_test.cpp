// The search against a plain loop: the same entry, half turn and bits of the cost.
#include "algorithm/vq/rotation_search.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace sgs {
namespace {

using Random = std::mt19937_64;
using Quat = std::array<float, kQuatDims>;

Quat unit(const std::array<double, kQuatDims>& q) {
  double squared = 0;
  for (const double c : q) squared += c * c;
  Quat out{};
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = static_cast<float>(q[k] / std::sqrt(squared));
  }
  return out;
}

// Canonical: the largest component first.
Quat random_quat(Random& random, double spread) {
  std::normal_distribution<double> normal(0, spread);
  std::array<double, kQuatDims> q = {1 + normal(random), normal(random), normal(random),
                                     normal(random)};
  std::iter_swap(q.begin(), std::max_element(q.begin(), q.end(), [](double a, double b) {
                   return std::abs(a) < std::abs(b);
                 }));
  return unit(q);
}

RotationMatch plain_loop(const std::vector<float>& quats, const float* point) {
  RotationMatch best{0, 0, std::numeric_limits<float>::infinity()};
  for (std::size_t half_turn = 0; half_turn < 4; ++half_turn) {
    if (!near_border(point, half_turn)) continue;
    const Monomials coefficients = coefficients_of(rotation_cost(point, half_turn));
    for (std::uint32_t entry = 0; entry < quats.size() / kQuatDims; ++entry) {
      const Monomials monomials = monomials_of(&quats[std::size_t{entry} * kQuatDims]);
      float cost = 0;
      for (std::size_t m = 0; m < kMonomials; ++m) cost += coefficients[m] * monomials[m];
      if (cost < best.cost || (cost == best.cost && entry < best.entry)) {
        best = {entry, half_turn, cost};
      }
    }
  }
  return best;
}

// Points near entries and anywhere, of ellipsoids of every kind.
void check_search(std::size_t entries, double spread, std::size_t distinct) {
  INFO(entries << " entries, spread " << spread << ", " << distinct << " distinct");
  Random random(entries + distinct);
  std::vector<float> quats;
  for (std::size_t e = 0; e < entries; ++e) {
    Quat q = random_quat(random, spread);
    if (e >= distinct) std::copy_n(&quats[random() % distinct * kQuatDims], kQuatDims, q.begin());
    quats.insert(quats.end(), q.begin(), q.end());
  }
  const RotationSearch search(quats);
  std::uniform_real_distribution<float> share(0, 1);
  for (int k = 0; k < 400; ++k) {
    Quat q = random_quat(random, spread);
    if (k % 2 == 0) std::copy_n(&quats[random() % entries * kQuatDims], kQuatDims, q.begin());
    const std::array<float, 3> kinds[] = {
        {0, 0, 0}, {1, 0, 0}, {0, 0.5F, 0.5F}, {0.02F, 0.49F, 0.49F}, {share(random), 0, 0}};
    std::array<float, 3> shares = kinds[static_cast<std::size_t>(k) % 5];
    if (k % 5 == 4) shares[1] = 1 - shares[0];
    const float point[kRotationDims] = {q[0], q[1], q[2], q[3], shares[0], shares[1], shares[2]};
    const RotationMatch expected = plain_loop(quats, point), got = search.find(point);
    REQUIRE(got.entry == expected.entry);
    REQUIRE(got.half_turn == expected.half_turn);
    REQUIRE(got.cost == expected.cost);
  }
}

TEST_CASE("rotation search: from one entry to more than a run of leaves") {
  for (const std::size_t entries : {1U, 2U, 15U, 16U, 17U, 255U, 256U, 257U, 4096U, 5000U}) {
    check_search(entries, 1, entries);
  }
}

TEST_CASE("rotation search: entries close together, and many of the same") {
  for (const double spread : {1e-1, 1e-3, 1e-6, 0.0}) check_search(1000, spread, 1000);
  for (const std::size_t distinct : {1U, 3U, 40U}) check_search(1000, 1, distinct);
}

}  // namespace
}  // namespace sgs
