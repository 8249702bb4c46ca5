#include "algorithm/tune/cloud_gradient.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sgs {

void CloudGradient::add_rows(const std::vector<std::uint32_t>& more) {
  std::vector<std::uint32_t> all;
  all.reserve(indices.size() + more.size());
  std::set_union(indices.begin(), indices.end(), more.begin(), more.end(), std::back_inserter(all));
  if (all.size() == indices.size()) return;
  const int degree = parameters.sh_degree;
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(degree));
  CloudGradient out;
  out.resize(all.size(), degree);
  std::size_t from = 0;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const bool had = from < indices.size() && indices[from] == all[r];
    GaussianCloud& by = out.parameters;
    by.means[r] = had ? parameters.means[from] : glm::vec3(0.0F);
    by.log_scales[r] = had ? parameters.log_scales[from] : glm::vec3(0.0F);
    by.quats[r] = had ? parameters.quats[from] : std::array<float, 4>{};
    by.opacity_logits[r] = had ? parameters.opacity_logits[from] : 0.0F;
    glm::vec3* const colour = &by.sh_coeffs[r * coeffs];
    if (had) {
      std::copy_n(&parameters.sh_coeffs[from * coeffs], coeffs, colour);
    } else {
      std::fill_n(colour, coeffs, glm::vec3(0.0F));
    }
    out.centres[r] = had ? centres[from] : glm::vec2(0.0F);
    from += had ? 1 : 0;
  }
  out.indices = std::move(all);
  *this = std::move(out);
}

}  // namespace sgs
