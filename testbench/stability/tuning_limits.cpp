// tuning_limits: how long the steps of a tuning may be, scene by scene and parameter by parameter,
// as a table.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <systemc>

#include "testbench/command_line/program.h"
#include "testbench/stability/stiff_tuning.h"
#include "tlm/no_banner.h"

namespace {

using namespace sgs;

// By decades: the best, the last that went to its end, the first that stopped.
std::string row(const StiffCase& of, int steps, int decades) {
  StiffRun usual{}, best{}, last{}, stopped{};
  bool good = true;
  for (int decade = 0; decade <= decades; ++decade) {
    const StiffRun run = tuned(of, std::pow(10, decade), steps);
    good = good && run.good;
    if (decade == 0) usual = run;
    if (!run.stopped.empty()) {
      stopped = run;
      break;
    }
    if (decade == 0 || run.last_loss < best.last_loss) best = run;
    last = run;
  }
  const auto power = [](const StiffRun& run) {
    return run.factor > 0 ? fmt::format("10^{:.0f}", std::log10(run.factor)) : std::string("none");
  };
  return fmt::format("| {} | {} | {:.3g} | {:.3g} | {}: {:.3g} | {} | {} | {} |", of.scene,
                     of.rates, usual.first_loss, usual.last_loss, power(best), best.last_loss,
                     power(last),
                     stopped.stopped.empty() ? "never" : power(stopped) + ": " + stopped.stopped,
                     good ? "yes" : "NO");
}

}  // namespace

int sc_main(int argc, char* argv[]) {
  std::uint32_t steps = 40, decades = 24;
  CommandLine line("tuning_limits", "How long the steps of a tuning may be");
  line.whole("--steps", steps, 1, 100'000, "of each tuning");
  line.whole("--decades", decades, 0, 36, "of factors of the rates that are tried, from 1");
  return run_program(line, argc, argv, [&] {
    fmt::print(
        "| scene | rates | loss at first | behind {} steps | best factor: its loss | goes to its "
        "end "
        "up to | stops at: what it says | what is left is good |\n"
        "|---|---|---:|---:|---|---|---|---|\n",
        steps);
    for (const StiffCase& of : stiff_cases()) {
      fmt::print("{}\n", row(of, static_cast<int>(steps), static_cast<int>(decades)));
    }
    return kDone;
  });
}
