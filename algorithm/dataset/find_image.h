// The image file that a data set means by a name.
#pragma once

#include <string>
#include <vector>

#include "algorithm/image/image_header.h"

namespace sgs {

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

}  // namespace sgs
