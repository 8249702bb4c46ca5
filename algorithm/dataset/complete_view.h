// Brings together the camera that a data set states and the image that lies there.
#pragma once

#include "algorithm/dataset/stated_view.h"

namespace sgs {

// Whether one factor brings both stated sides to within a pixel of the others.
bool of_one_shape(int width, int height, int stated_width, int stated_height);

// Scales the intrinsics to the image, whose size may be the stated one times a common factor, each
// side rounded either way. Then cuts off the image's side that has the principal point farther from
// its border, until it is in the middle within half a pixel: Camera knows no other place, and
// leaving it would turn the camera. Throws InputError that begins with view.where: sizes that do
// not match or are above 65536, a focal length or position that is not finite or beyond
// scene/gaussian_limits.h, a principal point outside of the middle half.
DatasetView complete_view(const StatedView& view);

}  // namespace sgs
