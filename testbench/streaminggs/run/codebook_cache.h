// Codebooks of scenes, kept for later runs: making them takes longer than all else of a frame.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

// Each entry is a packed scene (image_file.h) in the order that it came in. Its name is a digest of
// all that it follows from: the activated Gaussians, the cameras that weigh them, the keys of the
// codebooks, and this very program. Written whole or not at all.
class CodebookCache {
 public:
  static constexpr const char* kOff = "off";
  // The oldest entries give way beyond this.
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;

  // Nothing is kept.
  CodebookCache() = default;
  // folder: made where it is not there; kOff: nothing is kept. Empty: what $STREAMINGGS_CACHE says,
  // else streaminggs/ in $XDG_CACHE_HOME, else in ~/.cache.
  explicit CodebookCache(const std::string& folder);

  // An earlier call's, or those of `make`. The terminal shows where they come from, and why an
  // entry is of no use or could not be kept.
  QuantisedCloud codebooks(const ActivatedCloud& cloud, const VqConfig& config,
                           const std::vector<Camera>& weighing,
                           const std::function<QuantisedCloud()>& make) const;

 private:
  std::string folder_;  // empty: nothing is kept
};

}  // namespace sgs
