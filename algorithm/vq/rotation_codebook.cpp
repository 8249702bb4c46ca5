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

namespace sgs {
namespace {

constexpr int kQuatDims = 4;
constexpr int kDims = kQuatDims + 3;  // quaternion, share of each axis in the sensitivity

struct Match {
  std::uint32_t entry = 0;
  std::size_t half_turn = 0;  // after which it costs that
  float cost = 0;
};

// A shape's quaternion q and q i, q j, q k: the entry q' is off by the turn whose half angle's sine
// has the components q' . q i, q' . q j, q' . q k about the shape's own axes.
using Frame = std::array<glm::dvec4, 4>;
Frame frame_of(const float* q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {glm::dvec4(w, x, y, z), glm::dvec4(-x, w, z, -y), glm::dvec4(-y, -z, w, x),
          glm::dvec4(-z, y, -x, w)};
}

// Which of the frame's four play the turns about axes 0, 1, 2 after each of the half turns that
// leave an ellipsoid as it is: none, about axis 0, 1, 2.
constexpr std::size_t kTurns[4][3] = {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}};

// The matrix whose quadratic form is the cost of an entry, after a half turn.
glm::dmat4 cost_matrix(const Frame& frame, const float* share, std::size_t half_turn) {
  glm::dmat4 matrix(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const glm::dvec4& e = frame[kTurns[half_turn][axis]];
    matrix += static_cast<double>(share[axis]) * glm::outerProduct(e, e);
  }
  return matrix;
}

// Half turns after which an entry could be nearer: canonical quaternions have their largest
// component first, and a half turn about axis k puts component k there. Far from the border of the
// canonical domain there is no entry to be found across it.
bool near_border(const float* q, std::size_t half_turn) {
  constexpr float kNear = 0.6F;
  return half_turn == 0 || std::abs(q[half_turn]) > kNear * std::abs(q[0]);
}

// A quadratic form of four variables has ten coefficients; the entries' monomials stand side by
// side, so that a loop over entries is vector code.
constexpr std::size_t kMonomials = 10;
constexpr int kFactors[kMonomials][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                         {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

class EntryTable {
 public:
  explicit EntryTable(const std::vector<float>& quats) {
    const std::size_t count = quats.size() / kQuatDims;
    const std::size_t blocks = (count + kLanes - 1) / kLanes;
    monomials_.resize(blocks * kMonomials * kLanes);
    for (std::size_t e = 0; e < blocks * kLanes; ++e) {
      // Padded with the first entry, which loses every tie against itself.
      const float* q = quats.data() + (e < count ? e : 0) * kQuatDims;
      for (std::size_t m = 0; m < kMonomials; ++m) {
        monomials_[(e / kLanes * kMonomials + m) * kLanes + e % kLanes] =
            q[kFactors[m][0]] * q[kFactors[m][1]];
      }
    }
  }

  // The entry that costs the point least; of equal ones the first.
  Match find(const float* point) const {
    const Frame frame = frame_of(point);
    Match best{0, 0, std::numeric_limits<float>::infinity()};
    for (std::size_t half_turn = 0; half_turn < 4; ++half_turn) {
      if (!near_border(point, half_turn)) continue;
      const glm::dmat4 matrix = cost_matrix(frame, point + kQuatDims, half_turn);
      float coefficients[kMonomials];
      for (std::size_t m = 0; m < kMonomials; ++m) {
        const int* factors = kFactors[m];
        const double twice = factors[0] == factors[1] ? 1 : 2;
        coefficients[m] = static_cast<float>(twice * matrix[factors[0]][factors[1]]);
      }
      compare(coefficients, half_turn, best);
    }
    return best;
  }

 private:
  static constexpr std::uint32_t kLanes = 64;  // enough that the loop over them is not unrolled

  void compare(const float (&coefficients)[kMonomials], std::size_t half_turn, Match& best) const {
    float least[kLanes];
    std::int32_t least_block[kLanes] = {};
    std::fill_n(least, kLanes, std::numeric_limits<float>::infinity());
    const auto blocks = static_cast<std::int32_t>(monomials_.size() / (kMonomials * kLanes));
    for (std::int32_t block = 0; block < blocks; ++block) {
      const float* values =
          monomials_.data() + static_cast<std::size_t>(block) * kMonomials * kLanes;
      float costs[kLanes];
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        float cost = 0;
        for (std::size_t m = 0; m < kMonomials; ++m) {
          cost += coefficients[m] * values[m * kLanes + lane];
        }
        costs[lane] = cost;
      }
      // Masks, not selections: two of one condition make a branch.
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::int32_t less = -static_cast<std::int32_t>(costs[lane] < least[lane]);
        least_block[lane] = (block & less) | (least_block[lane] & ~less);
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        least[lane] = std::min(least[lane], costs[lane]);
      }
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t entry = static_cast<std::uint32_t>(least_block[lane]) * kLanes + lane;
      if (least[lane] < best.cost || (least[lane] == best.cost && entry < best.entry)) {
        best = {entry, half_turn, least[lane]};
      }
    }
  }

  std::vector<float> monomials_;  // [blocks, monomials, lanes]
};

std::vector<Match> match_all(const PointSet& points, const std::vector<float>& quats) {
  const EntryTable table(quats);
  std::vector<Match> matches(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      matches[i] = table.find(points[i]);
    }
  });
  return matches;
}

// Moves each entry to the quaternion of least cost for its points: the eigenvector of the smallest
// eigenvalue, by inverse iteration from the present one.
void move_entries(const PointSet& points, const std::vector<Match>& matches,
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
      sum += static_cast<double>(points.weights[i]) *
             cost_matrix(frame_of(points[i]), points[i] + kQuatDims, matches[i].half_turn);
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

double mean_cost(const PointSet& points, const std::vector<Match>& matches) {
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
  PointSet points{kDims, std::vector<float>(shapes.size() * kDims), weights};
  tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t i) {
    const std::array<float, 3> sensitivity = turn_sensitivity(shapes[i].scale, pixel_sizes[i]);
    const float sum = sensitivity[0] + sensitivity[1] + sensitivity[2];
    float* const point = &points.values[i * kDims];
    std::copy_n(shapes[i].quat.begin(), kQuatDims, point);
    for (std::size_t k = 0; k < 3; ++k) {
      point[kQuatDims + k] = sum > 0 ? sensitivity[k] / sum : 0;
    }
    points.weights[i] *= sum;
  });
  return points;
}

std::vector<std::uint32_t> labels_of(const std::vector<Match>& matches) {
  std::vector<std::uint32_t> labels(matches.size());
  std::transform(matches.begin(), matches.end(), labels.begin(),
                 [](const Match& match) { return match.entry; });
  return labels;
}

}  // namespace

std::array<float, 3> turn_sensitivity(const glm::vec3& falling_scale, float pixel_size) {
  // Where pixels are not known, thinner than this share of the longest axis is not seen.
  constexpr double kThinnest = 0.02;
  constexpr double kLeastPixel = 1e-4;  // of the longest axis; keeps quotients finite
  constexpr double kSaturation = 0.05;  // radians of half angle at sensitivity 1
  double squares[3], seen[3];
  const double longest = falling_scale[0];
  for (int k = 0; k < 3; ++k) {
    // Of equal scales the ratio is 1 also where both are 0 or have overflowed.
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
    const std::vector<Match> matches = match_all(training, out.quats);
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
