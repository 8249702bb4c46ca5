#include "testbench/streaminggs/fitting/fitting_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "testbench/command_line/guard.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/report/provenance.h"

namespace sgs {
namespace {

FittingLog::Earlier earlier(const std::optional<Checkpoint>& from) {
  if (!from) return {};
  return {from->log, from->seconds};
}

class FittingRun {
 public:
  FittingRun(const FittingArguments& arguments, const FittingTask& task,
             const std::optional<Checkpoint>& from)
      : arguments_(arguments), task_(task), log_(task.fitting.steps(), task.more, earlier(from)) {}

  int run(bool look_first) {
    const int first = task_.fitting.next_step();
    try {
      const Interrupt interrupt;
      if (look_first) look({});
      while (!task_.fitting.done()) {
        if (interrupt.wished()) return stopped();
        step();
      }
      task_.write();
      log_.end();
      return kDone;
    } catch (const std::exception& error) {
      // All photographs are read for the first step: what cannot be is bad input, and nothing is
      // lost.
      const bool of_input = dynamic_cast<const InputError*>(&error) != nullptr;
      if (of_input && task_.fitting.next_step() == first) throw;
      const bool too_fast = dynamic_cast<const NotFinite*>(&error) != nullptr;
      throw std::runtime_error(
          fmt::format("{}; {}{}", error.what(), kept(), too_fast ? slower() : ""));
    }
  }

 private:
  void look(std::optional<double> loss) {
    log_.add(task_.fitting.next_step(), loss, task_.fitting.gaussians(), task_.look());
    if (arguments_.log.empty()) return;
    write_whole_file(arguments_.log, log_.csv().data(), log_.csv().size());
  }

  void step() {
    Fitting& fitting = task_.fitting;
    const FittingStep step = fitting.step();
    log_.tell(step, fitting.gaussians());
    const auto every = [&](std::uint32_t steps) {
      return steps > 0 && fitting.next_step() % static_cast<int>(steps) == 0;
    };
    if (every(arguments_.test_every) || fitting.done()) look(step.loss);
    if (every(arguments_.checkpoint_every) && !fitting.done()) save();
  }

  void save() const {
    write_checkpoint(arguments_.checkpoint(), {task_.work, task_.pace, task_.contents, log_.csv(),
                                               log_.seconds(), task_.fitting.saved()});
  }

  // Says where the state is, or why it is nowhere.
  std::string kept() const {
    try {
      save();
    } catch (const std::exception& error) {
      return fmt::format("nor is its state saved: {}", error.what());
    }
    return fmt::format("the last good state is in {}", arguments_.checkpoint());
  }

  // Advice about steps that lead nowhere.
  const char* slower() const {
    return task_.pace.empty() ? "" : "; to go on: --resume it with a smaller --rate";
  }

  int stopped() {
    save();
    task_.write();
    fmt::print(stderr, "streaminggs: stopped before step {}; to go on: --resume {}\n",
               task_.fitting.next_step() + 1, arguments_.checkpoint());
    return kInterrupted;
  }

  const FittingArguments& arguments_;
  const FittingTask& task_;
  FittingLog log_;
};

}  // namespace

void FittingArguments::add_to(CommandLine& line, const char* scene_forms) {
  line.file("--out", out, scene_forms, Given::kAlways);
  line.file("--log", log, "steps, loss and quality as CSV");
  line.whole("--test-every", test_every, 1, 1'000'000, "steps: test views are drawn");
  line.whole("--checkpoint", checkpoint_every, 0, 1'000'000,
             "steps: OUT.checkpoint is written; 0: only when stopped, by Ctrl-C or a failure");
  line.one_of({"derivative", "original"}, "--gradients", gradients,
              "where alpha is capped and where a ratio is clamped: the derivative, or what the "
              "original's code takes for it");
  line.file("--resume", resume, "a checkpoint of the same work, to go on from");
  pictures.add_to(line);
}

void FittingArguments::add_to(OutputPlan& plan) const {
  plan.add_output(out);
  if (!log.empty()) plan.add_output(log);
  std::error_code error;
  if (!std::filesystem::equivalent(resume, checkpoint(), error)) {
    plan.add_input(resume);
    plan.add_output(checkpoint());
  }
  pictures.add_to(plan);
}

std::string FittingArguments::contents(const OutputPlan& plan) const {
  std::vector<std::string> files = plan.inputs();
  files.erase(std::remove(files.begin(), files.end(), resume), files.end());
  return digest_of_files(files);
}

std::optional<Checkpoint> FittingArguments::resumed(const std::string& work,
                                                    const std::string& contents) const {
  if (resume.empty()) return {};
  Checkpoint checkpoint = read_checkpoint(resume);
  if (checkpoint.work != work) {
    throw InputError(fmt::format("{}: is of '{}', expected '{}'", resume, checkpoint.work, work));
  }
  if (checkpoint.contents != contents) {
    throw InputError(fmt::format(
        "{}: a file that it was made from holds something else now, expected what '{}' read then",
        resume, work));
  }
  return checkpoint;
}

int run_fitting(const FittingArguments& arguments, const FittingTask& task,
                const std::optional<Checkpoint>& from, bool look_first) {
  const int done = task.fitting.next_step();
  if (done > task.fitting.steps()) {
    throw InputError(fmt::format("{}: has done {} steps, expected up to {}", arguments.resume, done,
                                 task.fitting.steps()));
  }
  if (from && from->pace != task.pace) {
    print_fact("resumed", fmt::format("behind step {} with {}, until there with {}", done,
                                      task.pace, from->pace));
  }
  return FittingRun(arguments, task, from).run(look_first);
}

}  // namespace sgs
