// error.png and, of a lossy order, missed.png and misordered.png.
#pragma once

#include <filesystem>

#include "testbench/streaminggs/view_result.h"

namespace sgs {

constexpr const char* kErrorMapFiles[] = {"error.png", "missed.png", "misordered.png"};

// Writes the view's maps (algorithm/image/error_map.h) into `folder` and removes those of an
// earlier run that this view does not have: missed.png is there only where splats were missed,
// misordered.png only where blends were out of order.
void write_error_maps(const std::filesystem::path& folder, const ViewResult& view);

}  // namespace sgs
