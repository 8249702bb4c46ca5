#include "testbench/streaminggs/fitting_run.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "testbench/command_line/guard.h"
#include "testbench/command_line/interrupt.h"

namespace sgs {
namespace {

class FittingRun {
 public:
  FittingRun(const FittingArguments& arguments, const FittingTask& task, std::string log)
      : arguments_(arguments), task_(task), log_(task.fitting.steps(), task.more, std::move(log)) {}

  void look(std::optional<double> loss) {
    log_.add(task_.fitting.next_step(), loss, task_.fitting.gaussians(), task_.look());
  }

  int run() {
    const Interrupt interrupt;
    try {
      while (!task_.fitting.done()) {
        if (interrupt.wished()) return stopped();
        step();
      }
    } catch (const NotFinite& error) {
      save();
      throw std::runtime_error(
          fmt::format("{}; the state before it is in {}", error.what(), arguments_.checkpoint()));
    }
    write_files();
    return kDone;
  }

 private:
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
    write_checkpoint(arguments_.checkpoint(), {task_.work, log_.csv(), task_.fitting.saved()});
  }

  int stopped() {
    save();
    write_files();
    fmt::print(stderr, "streaminggs {}: stopped before step {}; to go on: --resume {}\n",
               task_.command, task_.fitting.next_step() + 1, arguments_.checkpoint());
    return kInterrupted;
  }

  void write_files() const {
    if (!arguments_.log.empty()) {
      write_whole_file(arguments_.log, log_.csv().data(), log_.csv().size());
    }
    task_.write();
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
             "steps: OUT.checkpoint is written; 0: when stopped by Ctrl-C only");
  line.file("--resume", resume, "a checkpoint of the same work, to go on from");
  pictures.add_to(line);
}

void FittingArguments::add_to(OutputPlan& plan) const {
  plan.add_input(resume);
  plan.add_output(out);
  if (!log.empty()) plan.add_output(log);
  pictures.add_to(plan);
}

std::optional<Checkpoint> FittingArguments::resumed(const std::string& command,
                                                    const std::string& work) const {
  if (resume.empty()) return {};
  Checkpoint checkpoint = read_checkpoint(resume);
  if (checkpoint.work != work) {
    throw InputError(fmt::format("{}: is of '{} {}', expected '{} {}'", resume, command,
                                 checkpoint.work, command, work));
  }
  return checkpoint;
}

int run_fitting(const FittingArguments& arguments, const FittingTask& task, std::string log,
                bool from_start) {
  FittingRun run(arguments, task, std::move(log));
  if (from_start) run.look({});
  return run.run();
}

}  // namespace sgs
