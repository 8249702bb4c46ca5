// Describes the contents of a data set of photographs, for `info`.
#pragma once

#include "algorithm/dataset/dataset.h"

namespace sgs {

// Prints a line each: layout, views and their split, sizes, alpha, points, bounds, where the
// cameras stand; then its notes.
void print_dataset(const Dataset& dataset);

// Its notes alone, a line each.
void print_notes(const Dataset& dataset);

}  // namespace sgs
