// The view of an image: its camera made to fit.
#pragma once

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/stated_view.h"

namespace sgs {

// True if one factor brings both stated sides to within a pixel of the others.
bool of_one_shape(int width, int height, int stated_width, int stated_height);

// Throws InputError that begins with view.where: a lens that check_lens() refuses, a focal length
// or position that is not finite or beyond scene/gaussian_cloud.h.
void check_camera(const StatedView& view, const Projection& stated);

// Scales the intrinsics to the image, whose size may be the stated one times a common factor, each
// side rounded either way. A lens with distortion is made a pinhole (undistortion.h). A pinhole's
// image is cut at the side that has the principal point farther from its border, until it is in the
// middle within half a pixel. Throws InputError that begins with view.where: sizes that do not
// match or are above 65536, what check_camera() and pinhole_picture() refuse, a pinhole's principal
// point outside of the middle half.
DatasetView complete_view(const StatedView& view, const FoundImage& found);

}  // namespace sgs
