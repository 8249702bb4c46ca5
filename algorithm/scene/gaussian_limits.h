// How large the parameters of Gaussians and cameras may be: what lies within is drawn, what lies
// beyond is refused by name, so that nothing vanishes where a computation leaves float.
//
// The steepest computation is the projection. With f the focal length, v_z > 0.2 the depth and S
// the largest scale, a splat is up to sigma = f S / v_z px wide. Its covariance, sigma^2, stays
// within float for every f and S within the limits. The determinant, sigma^4, does not: from sigma
// of 4 10^9 px it may be infinite and the conic 0, so that the splat is as opaque everywhere as it
// is at its centre. That is right to the eye unless the centre lies as far off the frame as a tenth
// of sigma, and takes a Gaussian of scale 10^7 nearer than f / 430. No limit on S alone lets pass
// all that some camera could show, from far enough, and nothing that another would lose. Distances
// are squared for the direction of colour: coordinates of 10^18 give 1.2e37. SH coefficients are
// squared where codebooks are trained.
#pragma once

namespace sgs {

constexpr double kMaxCoordinate = 1e18;      // magnitude, world units: Gaussians and cameras
constexpr double kMaxCoefficient = 1e18;     // magnitude of SH coefficients
constexpr double kMaxScale = 1e7;            // world units
constexpr double kMaxLogScale = 16.1180956;  // ln(kMaxScale)
constexpr double kMaxFocalPx = 1e9;

}  // namespace sgs
