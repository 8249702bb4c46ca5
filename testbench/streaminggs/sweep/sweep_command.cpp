// streaminggs sweep SCENE... --out RESULTS.jsonl
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "testbench/command_line/guard.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/sweep/sweep.h"
#include "testbench/streaminggs/sweep/sweep_arguments.h"
#include "testbench/streaminggs/sweep/sweep_progress.h"
#include "testbench/streaminggs/sweep/sweep_results.h"
#include "testbench/streaminggs/sweep/sweep_simulations.h"
#include "testbench/streaminggs/sweep/sweep_table.h"
#include "testbench/streaminggs/sweep/sweep_task.h"

namespace sgs {
namespace {

struct Stopped {};  // thrown out of planning and the making of codebooks

// Whatever has a result of what was asked for, in the order in which that was.
class Asked {
 public:
  void add(const std::vector<SweepTask>& tasks) {
    for (const SweepTask& task : tasks) asked_.emplace_back(task.key, task.words);
  }
  void write_table(const SweepResults& results, const std::string& path) const {
    SweepTable table;
    for (const auto& [key, words] : asked_) {
      if (results.find(key) != nullptr) table.add(answer_of(results.line(key), "", words, true));
    }
    const std::string text = table.csv();
    write_whole_file(path, text.data(), text.size());
  }

 private:
  std::vector<std::pair<std::string, PointInWords>> asked_;
};

// empty: those done that no Gaussian contributes to.
void print_end(const SweepCounts& counts, std::uint64_t empty, const std::string& first_refusal,
               const std::string& out) {
  if (counts.refused > 0) {
    fmt::print("the first of {} refused: {}\n", grouped(counts.refused), first_refusal);
  }
  fmt::print(
      "{} of {} simulations: {} done, {} refused, {} failed; {} of them by an earlier sweep\n",
      grouped(counts.answered()), grouped(counts.asked), grouped(counts.done),
      grouped(counts.refused), grouped(counts.failed), grouped(counts.kept));
  if (empty > 0) {
    fmt::print("{} of {} frames hold no Gaussian\n", grouped(empty), grouped(counts.done));
  }
  fmt::print("results in {}\n", out);
}

int run(const SweepArguments& arguments, const Kinds& kinds) {
  const auto began = std::chrono::steady_clock::now();
  std::vector<SweepPoint> points = arguments.listed_points();
  SweepDefaults defaults{arguments.all,
                         arguments.each_scene(),
                         arguments.all.view,
                         arguments.all.size,
                         arguments.stereo,
                         arguments.config,
                         xxh64_of_file(arguments.technology)};
  if (defaults.scenes.empty() && !arguments.axes.empty()) {
    throw InputError(fmt::format("SCENE: got none, expected {}", kSceneForms));
  }
  Technology technology = load_technology(arguments.technology);
  arguments.check_places();
  if (!technology.note.empty()) fmt::print(stderr, "streaminggs: note: {}\n", technology.note);
  const RunFacts facts{technology.name,
                       arguments.technology,
                       defaults.technology_hash,
                       BuildOptions{}.stalls.seed,
                       "",  // points say theirs
                       command_line(),
                       began};
  SweepPlan plan(std::move(defaults), kinds);
  for (const std::string& note : plan.check_scenes()) {
    if (!arguments.streaming()) fmt::print("{}\n", note);
  }

  const Interrupt interrupt;
  SweepProgress progress;
  SweepResults results(arguments.out);
  SweepSimulations simulations(plan, std::move(technology), facts,
                               [&](Codebook codebook, std::uint32_t iteration, double error) {
                                 if (interrupt.wished()) throw Stopped();
                                 progress.say(codebook, iteration, error);
                               });
  Sweep sweep(simulations, results, arguments.side_by_side);
  Asked asked;
  std::string first_refusal;
  std::uint64_t empty = 0;
  const auto planned = [&](const SweepPoint& point) {
    if (interrupt.wished()) throw Stopped();
    std::vector<SweepTask> tasks = plan.tasks_of(point);
    if (!arguments.csv.empty()) asked.add(tasks);
    return tasks;
  };
  sweep.stop = [&] { return interrupt.wished(); };
  sweep.progress = [&](const SweepCounts& counts) { progress.say(counts); };
  sweep.answer = [&](const SweepAnswer& answer) {
    if (arguments.streaming()) {
      const SweepTask& task = answer.task;
      fmt::print("{}\n", answer_of(answer.line, task.id, task.words, answer.kept));
      std::fflush(stdout);
    } else if (answer.status == kPointDone) {
      empty += holds_no_gaussian(answer.line) ? 1 : 0;
    } else if (answer.status == kPointFailed) {
      fmt::print("{}\n", in_short(answer.line));
    } else if (answer.status == kPointRefused && first_refusal.empty()) {
      first_refusal = in_short(answer.line);
    }
  };
  bool complete = false;
  try {
    std::vector<SweepTask> tasks;
    for (const SweepPoint& point : points) {
      for (SweepTask& task : planned(point)) tasks.push_back(std::move(task));
    }
    sweep.add(std::move(tasks));
    std::optional<PointStream> stream;
    if (arguments.streaming()) stream.emplace(STDIN_FILENO);
    complete = sweep.run(stream ? &*stream : nullptr, planned);
  } catch (const Stopped&) {
  }
  progress.end();
  if (!arguments.csv.empty()) asked.write_table(results, arguments.csv);
  if (arguments.streaming()) return complete ? kDone : kInterrupted;
  const SweepCounts& counts = sweep.counts();
  if (complete && counts.refused == counts.asked) {
    throw InputError(fmt::format("all of {} refused; the first: {}", counts.asked, first_refusal));
  }
  print_end(counts, empty, first_refusal, arguments.out);
  if (!complete) return kInterrupted;
  return counts.failed > 0 ? kFailed : kDone;
}

}  // namespace

SubCommand add_sweep_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<SweepArguments>();
  arguments->config.config = kinds.front().name;
  arguments->add_to(line);
  return [arguments, &kinds] { return run(*arguments, kinds); };
}

}  // namespace sgs
