// Stiff scenes and long steps: a tuning ends in numbers, or names step and Gaussian, and what is
// left is good.
#include "testbench/stability/stiff_tuning.h"

#include <catch2/catch.hpp>

namespace sgs::test {
namespace {

TEST_CASE("stiff tuning: goes to its end or names step and Gaussian, and what is left is good") {
  constexpr int kSteps = 5;
  int ended = 0, stopped = 0;
  for (const StiffCase& of : stiff_cases()) {
    for (const double factor : {1.0, 1e4, 1e9, 1e21, 1e36}) {
      CAPTURE(of.scene, of.rates, factor);
      const StiffRun run = tuned(of, factor, kSteps);
      CAPTURE(run.stopped);
      CHECK(run.good);
      if (run.stopped.empty()) {
        ++ended;
        CHECK(run.steps == kSteps);
        continue;
      }
      ++stopped;
      CHECK(run.steps < kSteps);
      CHECK(run.stopped.find("step " + std::to_string(run.steps + 1) + ": ") == 0);
      CHECK(run.stopped.find("Gaussian ") != std::string::npos);
    }
    // With the original's rates nothing stops, however stiff.
    CHECK(tuned(of, 1, kSteps).steps == kSteps);
  }
  for (const StiffCase& of : stiff_cases()) {
    // Rotations as they are, whatever the quaternions' lengths: the usual scene, at its own
    // picture.
    if (of.scene.find("quaternions") != 0) continue;
    CAPTURE(of.scene);
    const StiffRun run = tuned(of, 1, kSteps), usual = tuned(stiff_cases().front(), 1, kSteps);
    CHECK(run.last_loss == Approx(usual.last_loss).epsilon(0.2));
  }
  CHECK(ended > 0);
  CHECK(stopped > 0);
}

}  // namespace
}  // namespace sgs::test
