// The search for the files that a data set means by its names of images.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/stated_view.h"
#include "algorithm/image/image.h"

namespace sgs {

struct FoundImage {
  std::string name;  // as it was stated, or with / for back-slashes where the file is there
  std::string path;
  ImageHeader header;
};

class ImageSearch {
 public:
  // root: the folder of the data set. images: as DatasetOptions has it.
  ImageSearch(std::string root, std::string images)
      : root_(std::move(root)), images_(std::move(images)) {}

  // The file of view.image in one of view.folders, the first of these that is there: the name as it
  // stands; with the extension of an image behind it; both with / for back-slashes; an extension in
  // capitals or not. A folder `images` is the one to take instead. Throws InputError: none, with
  // view.where and what was looked for; more than one of a kind; an image that read_photograph()
  // does not take; no folder images and more than one to take instead.
  FoundImage image(const StatedView& view) const;

  // The same for view.mask. A folder `masks` is masks_N, where it is there and images_N is taken.
  FoundImage mask(const StatedView& view) const;

  // The folder that is taken for `images`; empty where none was yet.
  const std::string& instead() const { return instead_; }

 private:
  std::optional<FoundImage> found(const StatedView& view, const std::vector<std::string>& folders,
                                  const std::string& name) const;
  FoundImage found_or_refused(const StatedView& view, const std::vector<std::string>& folders,
                              const std::string& name) const;
  std::vector<std::string> below_root(const std::vector<std::string>& folders) const;
  std::string only_smaller_images(const std::string& where) const;

  std::string root_, images_;
  mutable std::string instead_;
};

// `name` without "./" before it and without the extension of an image behind it.
std::string view_name(const std::string& name);

// With / for back-slashes.
std::string slashed(std::string name);

}  // namespace sgs
