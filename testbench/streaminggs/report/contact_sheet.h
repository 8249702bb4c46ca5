// Many pictures on one sheet, with a line below each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// Pictures of one size, made smaller as they come.
class ContactSheet {
 public:
  // Those of `frames` that have a place, in order: all of them, or kMostTiles evenly spread.
  explicit ContactSheet(std::size_t frames);
  static constexpr std::size_t kMostTiles = 60;

  bool shows(std::size_t frame) const;
  // The next that is shown, of at least one pixel. The line has no letters but those of
  // algorithm/image/image.h.
  void add(const Image& picture, std::string line);

  // Rows of up to six. Not without a picture.
  Image sheet() const;

 private:
  struct Tile {
    Image picture;
    std::string line;
  };
  std::vector<std::size_t> shown_;
  std::vector<Tile> tiles_;
};

}  // namespace sgs
