// How much each Gaussian matters to pictures: the weights of vector quantisation.
#pragma once

#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// Weights [N], positive, of mean about 1. Two parts:
//   seen:      sum over pixels of (T alpha)^2 in the reference pictures of the cameras. An error of
//              a Gaussian's colour enters a pixel times T alpha, so to first order this is what its
//              squared error adds to the squared error of the pictures.
//   anywhere:  opacity times the mean projected area over a sphere of directions, s1 s2 + s2 s3 +
//              s3 s1 up to a factor, capped at its 99th percentile. For what these cameras do not
//              see and others will.
// 0.7 of the first and 0.3 of the second, each of mean 1; without cameras only the second. At most
// 64 cameras, evenly spaced, are rendered, none with more than 2^20 px. The same bits whatever the
// number of threads.
std::vector<float> image_weights(const ActivatedCloud& cloud, const std::vector<Camera>& cameras);

// World units of a pixel at each Gaussian [N], from the nearest camera: distance over focal length.
// 0 without cameras.
std::vector<float> pixel_sizes(const ActivatedCloud& cloud, const std::vector<Camera>& cameras);

}  // namespace sgs
