// The arguments of `sweep` on its command line.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "algorithm/files/data_files.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/run/scene_arguments.h"
#include "testbench/streaminggs/sweep/sweep_points.h"

namespace sgs {

struct SweepArguments {
  std::vector<std::string> scenes, cameras;
  SceneArguments all;  // arguments that hold for all of them
  ConfigSource config;
  std::vector<std::string> axes;
  std::string points, out, csv;
  std::string stereo;  // of all points that do not say theirs
  std::string technology = data_file("technology_32nm.json");
  std::uint32_t side_by_side = std::max(1U, std::thread::hardware_concurrency());

  void add_to(CommandLine& line);

  // True if points come on standard input.
  bool streaming() const;

  // Each scene with its cameras. Throws InputError.
  std::vector<SceneArguments> each_scene() const;

  // Those of the grid or the file; none where they come later. Throws InputError.
  std::vector<SweepPoint> listed_points() const;

  // Throws InputError where an output has no place, or would take that of an input.
  void check_places() const;
};

}  // namespace sgs
