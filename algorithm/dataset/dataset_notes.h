// What a user wants to know of a data set beside what it holds.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/dataset/dataset.h"

namespace sgs {

// A title and a sentence each: photographs made a pinhole's, with the share of pixels that is lost;
// masks; another folder of images (empty: none); names that were not read.
std::vector<std::pair<std::string, std::string>> notes_of(
    const Dataset& dataset, const std::map<std::string, int>& unread_keys,
    const std::string& instead_of_images);

}  // namespace sgs
