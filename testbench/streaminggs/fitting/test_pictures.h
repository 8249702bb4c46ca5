// Pictures of test views as a fitting goes, beside their photographs: for somebody to look at.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "algorithm/files/output_file.h"
#include "algorithm/train/evaluation.h"
#include "algorithm/train/photographs.h"
#include "testbench/command_line/command_line.h"

namespace sgs {

struct TestPictures {
  std::string folder;            // empty: none
  std::vector<int> views = {0};  // numbers of test views

  void add_to(CommandLine& line);
  void add_to(OutputPlan& plan) const;
  // view_N_photograph.png, before `background`. test: loaded. Throws InputError for a view that is
  // not there.
  void write_photographs(const Photographs& test, const glm::vec3& background) const;
  // Writes view_N_step_STEPS.png of what it is shown.
  PictureSeen behind(int steps) const;

 private:
  std::string file(int view, const std::string& what) const;
};

}  // namespace sgs
