// A camera on the way from one to another.
#pragma once

#include "algorithm/scene/camera.h"

namespace sgs {

// `a`, moved and turned towards `b`: on the line between their centres, on the shortest way between
// their axes. t: 0, as `a` stands, to 1, as `b` does. All else is `a`'s.
Camera camera_between(const Camera& a, const Camera& b, double t);

}  // namespace sgs
