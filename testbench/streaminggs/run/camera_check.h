// Cameras that most likely belong to another scene, or have other axes.
#pragma once

#include <string>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// A camera of its own scene sees more than this share of it. Of four cameras each of six captured
// scenes the least sees 1.4 % of the centres, close up in a garden; this is about a third of that.
// Cameras of other scenes see anything from nothing to everything: not each of them is told.
constexpr double kLeastShareInFrame = 0.005;

// Share of the Gaussians whose centres lie before the camera and within its frame, 0 to 1.
double share_in_frame(const ActivatedCloud& cloud, const Camera& camera);

// A line that doubts the camera and names the axes of the form that it was read from; empty where
// the share is larger, or the cloud has no Gaussians.
std::string doubt_about(const Camera& camera, const ActivatedCloud& cloud);

}  // namespace sgs
