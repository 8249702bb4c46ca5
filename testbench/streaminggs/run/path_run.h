// A camera path through a machine: every frame simulated, with the codebooks that the first one
// loads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/scene/camera.h"
#include "testbench/streaminggs/report/result_folder.h"
#include "testbench/streaminggs/run/run_setting.h"

namespace sgs {

struct PathJob {
  std::string name;            // the path's name
  std::vector<Camera> frames;  // at least one
  double frame_rate = 0;       // at which energy a second is told
};

// Every file that run_path() writes, but for the report.
std::vector<std::filesystem::path> files_of_path(const PathJob& job, const ResultFolder& out);

// Writes the pictures of a frame; those of the first take the place of an earlier run's files.
// right: of the right eye; null where there is one.
void write_frame(const ResultFolder& out, std::size_t number, const Image& left,
                 const Image* right);

// Prints a doubt about the first of its cameras that there is one about.
void print_doubt(const PathJob& job, const PreparedScene& scene);

// Simulates the frames of a path. Files of an earlier run in the folder are removed once the first
// frame is done. Returns the exit status: 1 where a frame is not the golden renderer's. Throws
// std::runtime_error, which names the frame, when one cannot be finished. dropping: as of
// run_views().
int run_path(const PathJob& job, RunSetting& setting, const ResultFolder& out, bool dropping);

}  // namespace sgs
