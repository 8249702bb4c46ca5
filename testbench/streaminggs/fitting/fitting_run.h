// A fitting from the step that it stands at to its last one, or to Ctrl-C: progress, log,
// checkpoints, files.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/files/output_file.h"
#include "algorithm/train/checkpoint.h"
#include "algorithm/train/fitting.h"
#include "algorithm/tune/splat_gradient.h"
#include "testbench/command_line/command_line.h"
#include "testbench/streaminggs/fitting/fitting_log.h"

namespace sgs {

// The arguments that all commands that fit a scene have in common.
struct FittingArguments {
  std::string out, log, resume;
  std::uint32_t test_every = 1'000, checkpoint_every = 0;
  std::string gradients = "derivative";
  TestPictures pictures;

  // scene_forms: what --out may be.
  void add_to(CommandLine& line, const char* scene_forms);
  void add_to(OutputPlan& plan) const;
  std::string checkpoint() const { return out + ".checkpoint"; }
  GradientRule gradient_rule() const {
    return gradients == "original" ? GradientRule::kOriginal : GradientRule::kDerivative;
  }
  // Digest of the files that the fitting reads: the inputs of the plan, but for a checkpoint.
  std::string contents(const OutputPlan& plan) const;
  // The one to go on from, if any. work, contents: what it must have been made by. Throws
  // InputError.
  std::optional<Checkpoint> resumed(const std::string& work, const std::string& contents) const;
};

struct FittingTask {
  std::string work, pace, contents;  // as in Checkpoint
  Fitting& fitting;
  std::vector<LogColumn> more;  // columns that look() fills in
  std::function<Look()> look;
  std::function<void()> write;  // the scene, to its place
};

// Looks at the test views as often as is asked for, behind the last step, and before the first one
// where `look_first`. from: what it goes on from, if anything. Returns the exit status. Throws
// InputError where that has done more steps than there are to do. Whatever fails on the way is a
// std::runtime_error, with the last good state saved as a checkpoint.
int run_fitting(const FittingArguments& arguments, const FittingTask& task,
                const std::optional<Checkpoint>& from, bool look_first);

}  // namespace sgs
