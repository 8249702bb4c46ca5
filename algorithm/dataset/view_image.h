// The image of a view: the file that the data set means, and its camera made to fit.
#pragma once

#include <string>
#include <vector>

#include "algorithm/dataset/stated_view.h"
#include "algorithm/image/image.h"

namespace sgs {

// The image file that a data set means by a name.
struct FoundImage {
  std::string path;
  ImageHeader header;
};

// The file `name` in one of `folders`, or else `name` with .png, .jpg or .jpeg (or in capitals)
// behind it. Throws InputError: none, with `where` and what was looked for; more than one; not a
// PNG or JPEG.
FoundImage find_image(const std::vector<std::string>& folders, const std::string& name,
                      const std::string& where);

// `name` without "./" before it and without the extension of an image behind it.
std::string view_name(const std::string& name);

// True if one factor brings both stated sides to within a pixel of the others.
bool of_one_shape(int width, int height, int stated_width, int stated_height);

// Scales the intrinsics to the image, whose size may be the stated one times a common factor, each
// side rounded either way. Then cuts off the image's side that has the principal point farther from
// its border, until it is in the middle within half a pixel: Camera knows no other place, and
// leaving it would turn the camera. Throws InputError that begins with view.where: sizes that do
// not match or are above 65536, a focal length or position that is not finite or beyond
// scene/gaussian_cloud.h, a principal point outside of the middle half.
DatasetView complete_view(const StatedView& view);

}  // namespace sgs
