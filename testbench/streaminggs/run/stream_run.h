// Frames of a camera path back to back through one machine, in one simulation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "testbench/streaminggs/report/result_folder.h"
#include "testbench/streaminggs/run/path_run.h"
#include "testbench/streaminggs/run/run_setting.h"

namespace sgs {

// Every file that run_stream_of() writes, but for the report.
std::vector<std::filesystem::path> files_of_stream(const PathJob& job, const ResultFolder& out);

// Simulates the frames of a path as a stream, shown at the path's rate; 0: each as soon as it is
// drawn. Returns the exit status: 1 where a frame is not the golden renderer's.
int run_stream_of(const PathJob& job, RunSetting& setting, const ResultFolder& out);

}  // namespace sgs
