// Spreads of trained_part.h. Scales are log-normal; deviations and shares are near those of trained
// files (tests/testbench/builtin has the bounds).
#include "testbench/builtin/trained_part.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "testbench/builtin/random.h"

namespace sgs {
namespace {

constexpr double kSizeMedian = 1.2, kSizeSpread = 0.7;  // of the even size; of its logarithm
constexpr double kAspectSpread = 1.4;                   // of the logarithm, one-sided
constexpr double kFlatness = 0.2, kFlatnessSpread = 0.8;
constexpr double kTilt = 0.12;  // radians
constexpr double kDepth = 0.4;  // off the surface, in even sizes

// Near nothing, half transparent, near opaque: U-shaped, as without pruning; large ones fainter.
double spread_opacity(double log_size, Random& random) {
  const double pick = random.uniform() + 0.25 * log_size;
  const double within = random.uniform();
  if (pick > 0.62) return 0.002 * std::pow(60.0, within);
  if (pick > 0.36) return 0.12 + 0.48 * within;
  return 0.995 - 0.395 * within * within;
}

void turn(const glm::dvec3& about, double angle, glm::dmat3& axes) {
  axes = glm::mat3_cast(glm::angleAxis(angle, about)) * axes;
}

}  // namespace

ScenePart trained_part(ScenePart even) {
  const double share = even.share;
  return {share, [even = std::move(even.surfel)](const PartSample& sample, Random& random) {
            Surfel surfel = even(sample, random);
            const double cover = std::sqrt(surfel.sigmas.x * surfel.sigmas.y);
            const double log_size = kSizeSpread * random.normal();
            const double size = cover * kSizeMedian * std::exp(log_size);
            const double aspect = std::exp(kAspectSpread * std::abs(random.normal()));
            surfel.position += surfel.axes[2] * (kDepth * cover * random.normal());
            turn(surfel.axes[2], random.uniform(0.0, M_PI), surfel.axes);
            const glm::dvec3 about = random.direction();
            turn(about, kTilt * random.normal(), surfel.axes);
            const double wide = size * std::sqrt(aspect), narrow = size / std::sqrt(aspect);
            surfel.sigmas = {wide, narrow,
                             narrow * kFlatness * std::exp(kFlatnessSpread * random.normal())};
            surfel.opacity *= spread_opacity(log_size, random);
            return surfel;
          }};
}

}  // namespace sgs
