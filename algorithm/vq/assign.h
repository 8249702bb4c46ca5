// To each Gaussian the entries that suit it best, of codebooks that are there.
#pragma once

#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

// Indices and opacities of `quantised` anew, by the distances that quantise() goes by; codebooks
// stay but for entries that no Gaussian is nearest to: each of these is put on the Gaussian whose
// error, times its weight, is the largest that is left (but for rotations, whose entries few are
// idle of). weights, pixel_sizes: as there. The same result whatever the number of threads.
void assign_entries(const ActivatedCloud& cloud, const std::vector<float>& weights,
                    const std::vector<float>& pixel_sizes, QuantisedCloud& quantised);

}  // namespace sgs
