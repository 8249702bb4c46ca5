// Bands of spherical harmonics that a scene stores: all of them, or those that its colours need
// (storage.sh_tolerance).
#pragma once

#include "algorithm/memory/storage_config.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

struct ShBands {
  int degree = 0;         // degree that is stored
  double most_error = 0;  // most that the bands beyond it add to a channel of any colour
};

// The lowest degree whose colours, of every Gaussian that is stored and from every direction, are
// within config.sh_tolerance of the whole ones; the cloud's own where that is 0. By the addition
// theorem the squares of a band's basis functions sum to (2 l + 1) / (4 pi) in any direction, so
// that band l adds at most sqrt((2 l + 1) / (4 pi)) times the length of its coefficients. A pixel
// is a mean of colours and background, and no farther off than the worst of them; in exact
// arithmetic: beside this float rounds.
ShBands bands_to_store(const ActivatedCloud& cloud, const StorageConfig& config);

// The cloud without the bands beyond `degree`, at most its own.
ActivatedCloud with_bands(const ActivatedCloud& cloud, int degree);

}  // namespace sgs
