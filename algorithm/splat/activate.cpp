// Activation of a whole cloud, in parallel.
#include "algorithm/splat/activate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace sgs {

ActivatedCloud activate(const GaussianCloud& cloud) {
  ActivatedCloud out;
  out.sh_degree = cloud.sh_degree;
  out.gaussians.resize(cloud.size());
  out.sh_coeffs = cloud.sh_coeffs;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cloud.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      out.gaussians[i] = activate(raw_gaussian(cloud, i));
    }
  });
  return out;
}

}  // namespace sgs
