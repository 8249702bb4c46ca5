#include "algorithm/train/evaluation.h"

#include "algorithm/image/quality.h"
#include "algorithm/tune/group_sequences.h"

namespace sgs {

std::vector<Quality> qualities(const ActivatedCloud& cloud, const Photographs& photographs,
                               const glm::vec3& background, const PictureSeen& seen) {
  std::vector<Quality> out;
  for (std::size_t at = 0; at < photographs.size(); ++at) {
    const auto view = make_view<float>(photographs.camera(at));
    const Image picture = draw(reference_sequences(view, cloud), background).image;
    const Image target = photographs.before(at, background);
    if (seen) seen(at, picture);
    out.push_back({psnr_db(picture, target), ssim(picture, target)});
  }
  return out;
}

Quality mean_quality(const std::vector<Quality>& each) {
  Quality sum{0, 0};
  for (const Quality& one : each) {
    sum.psnr_db += one.psnr_db;
    sum.ssim += one.ssim;
  }
  const auto count = static_cast<double>(each.size());
  return {sum.psnr_db / count, sum.ssim / count};
}

}  // namespace sgs
