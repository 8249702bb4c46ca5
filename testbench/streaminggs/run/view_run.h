// Views of a scene through a machine, one after the other, each with its pictures and report.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "algorithm/scene/camera.h"
#include "testbench/streaminggs/report/result_folder.h"
#include "testbench/streaminggs/run/run_setting.h"

namespace sgs {

using NumberedCameras = std::vector<std::pair<int, Camera>>;

// Every file that run_views() writes, but for the report of all.
std::vector<std::filesystem::path> files_of_views(const NumberedCameras& views,
                                                  const ResultFolder& out);

// Simulates the views and writes their files and, at the end, the report of all that were finished.
// The first one's take the place of an earlier run's. One that fails is named and does not keep the
// others from running; a single one throws, and InputError when all are refused. dropping:
// --drop-invalid was given. Returns the exit status.
int run_views(const NumberedCameras& views, RunSetting& setting, const ResultFolder& out,
              bool dropping);

}  // namespace sgs
