// What an image file says of itself before its pixels.
#pragma once

namespace sgs {

struct ImageHeader {
  int width = 0, height = 0;  // px, from 1
  bool has_alpha = false;
};

}  // namespace sgs
