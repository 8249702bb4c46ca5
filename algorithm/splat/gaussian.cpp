// Gathering, in parallel.
#include "algorithm/splat/gaussian.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

// `stride` values a Gaussian.
template <class T>
std::vector<T> gathered(const std::vector<T>& from, const std::vector<std::uint32_t>& order,
                        std::size_t stride = 1) {
  std::vector<T> out(order.size() * stride);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, order.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      std::copy_n(from.data() + order[i] * stride, stride, out.data() + i * stride);
    }
  });
  return out;
}

}  // namespace

ActivatedCloud reordered(const ActivatedCloud& cloud, const std::vector<std::uint32_t>& order) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  return {cloud.sh_degree, gathered(cloud.gaussians, order),
          gathered(cloud.sh_coeffs, order, coeffs)};
}

GaussianCloud reordered(const GaussianCloud& cloud, const std::vector<std::uint32_t>& order) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  return {cloud.sh_degree,
          gathered(cloud.means, order),
          gathered(cloud.log_scales, order),
          gathered(cloud.quats, order),
          gathered(cloud.opacity_logits, order),
          gathered(cloud.sh_coeffs, order, coeffs)};
}

}  // namespace sgs
