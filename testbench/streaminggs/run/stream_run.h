// Frames of a camera path back to back through one machine, in one simulation.
#pragma once

#include "testbench/streaminggs/report/result_folder.h"
#include "testbench/streaminggs/run/path_run.h"
#include "testbench/streaminggs/run/run_setting.h"

namespace sgs {

// Simulates the frames of a path, at least two, as a stream, shown at the path's rate; 0: each as
// soon as it is drawn. The files are those of run_path(), and so is the exit status.
int run_stream(const PathJob& job, RunSetting& setting, const ResultFolder& out, bool dropping);

}  // namespace sgs
