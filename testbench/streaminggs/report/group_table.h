// groups.csv: what each group of pixels took, and what it lost.
#pragma once

#include <string>

#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

// Comma-separated, a line a group, row by row, below one with the names: number and pixels of the
// group, what its golden picture counts, then what the machine counts for the group.
// Empty where the machine has no groups.
std::string group_table(const ViewResult& view);

}  // namespace sgs
