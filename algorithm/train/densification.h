// More Gaussians where the picture pulls at those that are there, fewer where they show nothing:
// the rules of the original (Kerbl et al. 2023, section 5.2, and its released code).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"

namespace sgs {

struct DensificationConfig {
  double pull = 2e-4;             // mean |dL/d(centre)| above which more are needed, half screens
  double clone_share = 0.01;      // share of the scene's extent: larger ones are split
  double least_opacity = 0.005;   // fainter ones go
  double most_scale_share = 0.1;  // share of the extent, and
  double most_radius_px = 20;     // on the screen: larger ones go once opacities were reset
  double reset_opacity = 0.01;
};

// Statistics of the Gaussians between two densifications.
class DensificationStatistics {
 public:
  explicit DensificationStatistics(std::size_t count) { clear(count); }

  void clear(std::size_t count);
  // Adds what one step saw.
  void add(const GroupSequences& sequences, const CloudGradient& gradient);

  // Mean pull over the steps that saw the Gaussian, in half screens; 0 where none did.
  double pull(std::size_t i) const;
  // Three deviations along its long axis, the largest seen.
  double radius_px(std::size_t i) const { return radii_px_[i]; }

  bool operator==(const DensificationStatistics& other) const {
    return pulls_ == other.pulls_ && seen_ == other.seen_ && radii_px_ == other.radii_px_;
  }

  // For cereal.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pulls_, seen_, radii_px_);
  }

 private:
  std::vector<float> pulls_;
  std::vector<std::uint32_t> seen_;
  std::vector<float> radii_px_;
};

// Clones small ones and splits large ones in two, drawn from themselves with scales over 1.6, as
// far as `most` Gaussians allow, those first that are pulled most; then prunes. extent: of the
// scene, world units. prune_large: opacities were reset before.
void densify_and_prune(const DensificationConfig& config, const DensificationStatistics& seen,
                       double extent, bool prune_large, std::size_t most, std::uint64_t seed,
                       std::uint64_t step, GaussianCloud& cloud, Adam& adam);

// No opacity above config.reset_opacity; the optimiser's moments of opacities begin anew.
void reset_opacities(const DensificationConfig& config, GaussianCloud& cloud, Adam& adam);

}  // namespace sgs
