// Assignment of rotations by what is seen of the error, and the entries that suit their shapes
// best.
#include "algorithm/vq/rotation_codebook.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numeric>

#include "algorithm/splat/constants.h"
#include "algorithm/vq/rotation_search.h"

namespace sgs {
namespace {

std::vector<RotationMatch> match_all(const PointSet& points, const std::vector<float>& quats) {
  const RotationSearch search(quats);
  std::vector<RotationMatch> matches(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      matches[i] = search.find(points[i]);
    }
  });
  return matches;
}

// Moves each entry to the quaternion of least cost for its points: the eigenvector of the smallest
// eigenvalue, by inverse iteration from the present one.
void move_entries(const PointSet& points, const std::vector<RotationMatch>& matches,
                  std::vector<float>& quats) {
  const std::size_t entries = quats.size() / kQuatDims;
  std::vector<std::vector<std::uint32_t>> members(entries);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    members[matches[i].entry].push_back(static_cast<std::uint32_t>(i));
  }
  tbb::parallel_for(std::size_t{0}, entries, [&](std::size_t e) {
    float* entry = quats.data() + e * kQuatDims;
    glm::dmat4 sum(0.0);
    for (const std::uint32_t i : members[e]) {
      sum +=
          static_cast<double>(points.weights[i]) * rotation_cost(points[i], matches[i].half_turn);
    }
    const double trace = sum[0][0] + sum[1][1] + sum[2][2] + sum[3][3];
    if (!(trace > 0)) return;  // nobody cares
    constexpr double kRegular = 1e-9;
    constexpr int kSteps = 8;
    const glm::dmat4 inverse = glm::inverse(sum / trace + glm::dmat4(kRegular));
    glm::dvec4 q(entry[0], entry[1], entry[2], entry[3]);
    for (int step = 0; step < kSteps; ++step) q = glm::normalize(inverse * q);
    for (int c = 0; c < kQuatDims; ++c) {
      if (!std::isfinite(q[c])) return;
    }
    for (int c = 0; c < kQuatDims; ++c) entry[c] = static_cast<float>(q[c]);
  });
}

double mean_cost(const PointSet& points, const std::vector<RotationMatch>& matches) {
  double cost = 0, weight = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    cost += static_cast<double>(points.weights[i]) * std::max(0.0F, matches[i].cost);
    weight += points.weights[i];
  }
  return weight > 0 ? cost / weight : 0;
}

void normalise(std::vector<float>& quats) {
  for (std::size_t at = 0; at < quats.size(); at += kQuatDims) {
    double squared = 0;
    for (std::size_t c = 0; c < kQuatDims; ++c) {
      squared += static_cast<double>(quats[at + c]) * quats[at + c];
    }
    for (std::size_t c = 0; c < kQuatDims; ++c) {
      quats[at + c] = static_cast<float>(quats[at + c] / std::sqrt(squared));
    }
  }
}

// Canonical quaternions and each axis' share in the sensitivity, by which the weights are
// multiplied.
PointSet rotation_points(const std::vector<CanonicalShape>& shapes,
                         const std::vector<float>& weights, const std::vector<float>& pixel_sizes) {
  PointSet points{kRotationDims, std::vector<float>(shapes.size() * kRotationDims), weights};
  tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t i) {
    const std::array<float, 3> sensitivity = turn_sensitivity(shapes[i].scale, pixel_sizes[i]);
    const float sum = sensitivity[0] + sensitivity[1] + sensitivity[2];
    float* const point = &points.values[i * kRotationDims];
    std::copy_n(shapes[i].quat.begin(), kQuatDims, point);
    for (std::size_t k = 0; k < 3; ++k) {
      point[kQuatDims + k] = sum > 0 ? sensitivity[k] / sum : 0;
    }
    points.weights[i] *= sum;
  });
  return points;
}

std::vector<std::uint32_t> labels_of(const std::vector<RotationMatch>& matches) {
  std::vector<std::uint32_t> labels(matches.size());
  std::transform(matches.begin(), matches.end(), labels.begin(),
                 [](const RotationMatch& match) { return match.entry; });
  return labels;
}

}  // namespace

std::array<float, 3> turn_sensitivity(const glm::vec3& falling_scale, float pixel_size) {
  // Where pixels are not known, thinner than this share of the longest axis is not seen.
  constexpr double kThinnest = 0.02;
  constexpr double kLeastPixel = 1e-4;  // share of the longest axis; keeps quotients finite
  constexpr double kSaturation = 0.05;  // radians of half angle at sensitivity 1
  double squares[3], seen[3];
  const double longest = falling_scale[0];
  for (int k = 0; k < 3; ++k) {
    // The ratio of equal scales is 1 also where both are 0 or have overflowed.
    const double ratio =
        falling_scale[k] == falling_scale[0] ? 1 : static_cast<double>(falling_scale[k]) / longest;
    const double pixel =
        longest > 0 && pixel_size > 0 ? std::max(kLeastPixel, pixel_size / longest) : kThinnest;
    squares[k] = ratio * ratio;
    seen[k] = std::sqrt(squares[k] + kLowPass * pixel * pixel);
  }
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double change = (squares[i] - squares[j]) / (seen[i] * seen[j]);
    const double squared = change * change;
    out[k] = static_cast<float>(squared / (1 + squared * kSaturation * kSaturation));
  }
  return out;
}

RotationCodebook train_rotations(const std::vector<CanonicalShape>& shapes,
                                 const std::vector<float>& weights,
                                 const std::vector<float>& pixel_sizes, const KMeansConfig& config,
                                 const KMeansProgress& progress) {
  const PointSet points = rotation_points(shapes, weights, pixel_sizes);
  PointSet quats{kQuatDims, std::vector<float>(shapes.size() * kQuatDims), points.weights};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    std::copy_n(points[i], kQuatDims, &quats.values[i * kQuatDims]);
  }

  KMeansResult start = kmeans(quats, config, progress);
  RotationCodebook out{std::move(start.centroids), std::move(start.labels)};
  normalise(out.quats);
  if (start.mean_squared_error == 0) return out;  // every rotation has an entry of its own

  constexpr double kLeastGain = 0.03;
  const PointSet training = draw(points, config.training_points / 2, config.seed);
  double before = std::numeric_limits<double>::infinity();
  for (std::uint32_t iteration = 0; iteration < config.iterations; ++iteration) {
    const std::vector<RotationMatch> matches = match_all(training, out.quats);
    const double cost = mean_cost(training, matches);
    if (progress) progress(start.iterations + 1 + iteration, cost);
    if (cost >= before * (1 - kLeastGain)) break;
    before = cost;
    move_entries(training, matches, out.quats);
  }
  out.labels = labels_of(match_all(points, out.quats));
  return out;
}

std::vector<std::uint32_t> nearest_rotations(const std::vector<CanonicalShape>& shapes,
                                             const std::vector<float>& pixel_sizes,
                                             const std::vector<float>& quats) {
  const std::vector<float> even(shapes.size(), 1.0F);
  return labels_of(match_all(rotation_points(shapes, even, pixel_sizes), quats));
}

}  // namespace sgs
