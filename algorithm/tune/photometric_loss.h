// The loss between a picture and its photograph (Kerbl et al. 2023), and its derivatives.
#pragma once

#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// L = (1 - lambda) L1 + lambda (1 - SSIM), L1 and SSIM means over pixels and channels. Values are
// taken as they are; where all lie in [0, 1], SSIM is that of image/quality.h.
template <class T>
struct PhotometricLoss {
  double loss, l1, ssim;
  std::vector<T> gradient;  // dL/dpicture [height, width, rgb]
};

constexpr double kSsimShare = 0.2;  // lambda

// picture, target: [height, width, rgb]. T: float, or double for who wants its digits. The same
// bits whatever the number of threads. Working memory: 16 pictures.
template <class T>
PhotometricLoss<T> photometric_loss(const T* picture, const T* target, int width_px, int height_px,
                                    double lambda = kSsimShare);

struct ImageLoss {
  double loss, l1, ssim;
  Image gradient;  // dL/dpicture
};

// Throws InputError when the pictures differ in size or have no pixels.
ImageLoss photometric_loss(const Image& picture, const Image& target, double lambda = kSsimShare);

}  // namespace sgs
