// The codebook of rotations: k-means where the distance is what a wrong rotation does to a picture.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/vq/kmeans.h"
#include "algorithm/vq/vq_points.h"

namespace sgs {

struct RotationCodebook {
  std::vector<float> quats;           // [K, 4] unit quaternions (w, x, y, z)
  std::vector<std::uint32_t> labels;  // [N]
};

// By how much a turn about each axis of an ellipsoid changes its picture: squared, per squared half
// angle. A turn by t about axis k moves the covariance of axes i and j by t (s_i^2 - s_j^2), which
// is seen relative to s_i s_j: a disc on edge shows the least tilt, a ball no turn at all. Lengths
// are taken as at least the low-pass of a pixel of pixel_size world units (0: not known). A turn of
// more than a few thickness angles moves an edge aside altogether and gets no worse: the
// sensitivity stops at that.
std::array<float, 3> turn_sensitivity(const glm::vec3& falling_scale, float pixel_size);

// shapes: [N] canonical; weights: [N]; pixel_sizes: [N] world units of a pixel at each Gaussian.
// Starts from k-means over the canonical quaternions as points, then repeats: to each shape the
// entry q that costs least, sum_k a_k (e_k . q)^2 with e_k the shape's quaternion times i, j, k and
// a_k its sensitivities (the half turns about the ellipsoid's own axes, which change nothing, are
// tried as well); to each entry the quaternion of the least weighted sum of costs, an eigenvector
// of a 4x4 matrix. Deterministic by seed whatever the number of threads.
RotationCodebook train_rotations(const std::vector<CanonicalShape>& shapes,
                                 const std::vector<float>& weights,
                                 const std::vector<float>& pixel_sizes, const KMeansConfig& config,
                                 const KMeansProgress& progress);

// [N] to each shape the entry of quats ([K, 4], unit length) that costs least, as train_rotations()
// has it.
std::vector<std::uint32_t> nearest_rotations(const std::vector<CanonicalShape>& shapes,
                                             const std::vector<float>& pixel_sizes,
                                             const std::vector<float>& quats);

}  // namespace sgs
