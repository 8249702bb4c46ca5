// Counts in words.
#include "testbench/streaminggs/sweep/sweep_progress.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "testbench/streaminggs/report/numbers.h"

namespace sgs {
namespace {

// 3723 s -> "1:02:03"
std::string clock_text(double seconds) {
  const long all = std::lround(seconds);
  return fmt::format("{}:{:02}:{:02}", all / 3600, all / 60 % 60, all % 60);
}

}  // namespace

void SweepProgress::say(const SweepCounts& counts) const {
  std::string left;
  if (counts.simulated > 0) {
    const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
    left =
        fmt::format("; {} left", clock_text(seconds / static_cast<double>(counts.simulated) *
                                            static_cast<double>(counts.asked - counts.answered())));
  }
  line_->say(fmt::format("{} of {} done, {} refused, {} failed{}", grouped(counts.done),
                         grouped(counts.asked), grouped(counts.refused), grouped(counts.failed),
                         left));
}

void SweepProgress::say(Codebook codebook, std::uint32_t iteration, double error) const {
  if (const VqProgress say = line_->of_quantisation()) say(codebook, iteration, error);
}

}  // namespace sgs
