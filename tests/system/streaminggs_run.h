// Runs the `streaminggs` executable as a user would.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace sgs::test {

struct Outcome {
  int status = 0;  // exit status; 128 + signal where it was killed
  std::string out, err;
};

using Arguments = std::vector<std::string>;
Arguments joined(Arguments first, const Arguments& second);
// `--set key=value` for each of the assignments; the same behind other arguments.
Arguments settings(const Arguments& assignments);
Arguments with_settings(const Arguments& first, const Arguments& assignments);

Outcome run_program(const std::string& program, const Arguments& arguments);
Outcome run_streaminggs(const Arguments& arguments);

// The views of a report.json, each with the configuration that they have in common.
std::vector<nlohmann::json> views_of_report(const std::string& path);

// Everything that holds for a frame of its machine (tests/system/frame_checks.h,
// tile_frame_checks.h).
void check_frame(const nlohmann::json& view);

// One `streaminggs simulate` with `framebuffer: rgb32f`, so that frames can be compared to the bit.
class Simulation {
 public:
  // arguments: SCENE and options; --out is added. Fails the test when the exit status is not 0.
  explicit Simulation(const Arguments& arguments);

  const std::vector<nlohmann::json>& views() const { return views_; }
  // The frame of one of the views as written, byte by byte.
  std::string frame(std::size_t view) const;
  std::string folder() const { return out_.path(""); }

  // check_frame of every view.
  void check() const;

 private:
  ScratchFolder out_;
  std::vector<nlohmann::json> views_;
};

}  // namespace sgs::test
