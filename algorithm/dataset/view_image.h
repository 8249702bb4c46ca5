// The view of an image: its camera made to fit. load_view() and load_mask() of dataset.h are here.
#pragma once

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/stated_view.h"

namespace sgs {

// True if one factor brings both stated sides to within a pixel of the others.
bool of_one_shape(int width, int height, int stated_width, int stated_height);

// Scales the intrinsics to the image, whose size may be the stated one times a common factor, each
// side rounded either way. A lens with distortion is made a pinhole (lens.h); a pinhole's principal
// point stays where it is. Throws InputError that begins with view.where: sizes that do not match
// or are above 65536, what check_camera(), camera_of() and pinhole_picture() refuse.
DatasetView complete_view(const StatedView& view, const FoundImage& found);

}  // namespace sgs
