// How much a band can add, and clouds without it.
#include "algorithm/storage/sh_bands.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/storage/storage_scheme.h"

namespace sgs {
namespace {

// Most that bands 1 .. `degree` can add to one channel, [band]; bands from 1 on.
std::array<double, 4> most_of_bands(const glm::vec3* sh, int degree, int channel) {
  constexpr double kPi = 3.14159265358979323846;
  std::array<double, 4> most{};
  for (int band = 1; band <= degree; ++band) {
    double squares = 0;
    for (int k = band * band; k < (band + 1) * (band + 1); ++k) {
      squares += double{sh[k][channel]} * double{sh[k][channel]};
    }
    most[static_cast<std::size_t>(band)] = std::sqrt((2 * band + 1) / (4 * kPi) * squares);
  }
  return most;
}

}  // namespace

ShBands bands_to_store(const ActivatedCloud& cloud, const StorageConfig& config) {
  const int degree = cloud.sh_degree;
  if (config.sh_tolerance == 0) return {degree, 0};
  std::array<double, 4> error{};  // [degree] that is stored
  for (const std::uint32_t i : stored_gaussians(cloud, stored_of(config))) {
    for (int channel = 0; channel < 3; ++channel) {
      const std::array<double, 4> most = most_of_bands(cloud.sh(i), degree, channel);
      double beyond = 0;
      for (int kept = degree - 1; kept >= 0; --kept) {
        const auto at = static_cast<std::size_t>(kept);
        beyond += most[at + 1];
        error[at] = std::max(error[at], beyond);
      }
    }
  }
  for (int kept = 0; kept < degree; ++kept) {
    const double of_kept = error[static_cast<std::size_t>(kept)];
    if (of_kept <= config.sh_tolerance) return {kept, of_kept};
  }
  return {degree, 0};
}

ActivatedCloud with_bands(const ActivatedCloud& cloud, int degree) {
  ActivatedCloud out;
  out.sh_degree = degree;
  out.gaussians = cloud.gaussians;
  const auto kept = static_cast<std::size_t>(sh_coeff_count(degree));
  out.sh_coeffs.reserve(cloud.size() * kept);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out.sh_coeffs.insert(out.sh_coeffs.end(), cloud.sh(i), cloud.sh(i) + kept);
  }
  return out;
}

}  // namespace sgs
