// Describes the contents of a data set of photographs, for `info`.
#pragma once

#include "algorithm/dataset/dataset.h"

namespace sgs {

// Prints a line each: layout, views and their split, sizes, alpha, points, bounds, where the
// cameras stand.
void print_dataset(const Dataset& dataset);

}  // namespace sgs
