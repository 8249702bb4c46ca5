// error.png and, of a lossy order, missed.png and misordered.png.
#pragma once

#include <string>
#include <vector>

#include "algorithm/image/image.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

constexpr const char* kErrorMapFiles[] = {"error.png", "missed.png", "misordered.png"};

struct ErrorMap {
  std::string file;  // one of kErrorMapFiles
  Image image;
};

// The view's maps (algorithm/image/error_map.h): missed.png only where splats were missed,
// misordered.png only where blends were out of order.
std::vector<ErrorMap> error_maps(const ViewResult& view);

}  // namespace sgs
