#include "testbench/streaminggs/training_log.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "testbench/streaminggs/numbers.h"

namespace sgs {
namespace {

constexpr const char* kCsvHead = "step,seconds,loss,gaussians,test_psnr_db,test_ssim\n";

// Of the last line; 0 where there is none.
double seconds_of(const std::string& csv) {
  const std::size_t line = csv.rfind('\n', csv.size() - 2) + 1;
  const std::size_t comma = csv.find(',', line);
  return comma == std::string::npos ? 0 : std::strtod(csv.c_str() + comma + 1, nullptr);
}

}  // namespace

TrainingLog::TrainingLog(int steps, std::string csv)
    : steps_(steps), terminal_(::isatty(STDERR_FILENO) != 0), csv_(std::move(csv)) {
  if (csv_.empty()) {
    csv_ = kCsvHead;
  } else {
    before_s_ = seconds_of(csv_);
  }
  fmt::print("{:>8} {:>9} {:>11} {:>9} {:>8} {:>9} {:>8} {:>8}\n", "step", "loss", "Gaussians",
             "test PSNR", "SSIM", "seconds", "steps/s", "left s");
}

double TrainingLog::seconds() const {
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
  return took.count();
}

void TrainingLog::tell(const Trainer::Step& step, std::size_t gaussians) {
  if (first_step_ < 0) first_step_ = step.number;
  if (!terminal_) return;
  const double rate = (step.number + 1 - first_step_) / seconds();
  fmt::print(stderr, "\r{:<79}\r",
             fmt::format("step {} of {}, loss {:.4f}, {} Gaussians, {:.1f} steps/s, {:.0f} s left",
                         step.number + 1, steps_, step.loss, grouped(gaussians), rate,
                         (steps_ - step.number - 1) / rate));
}

void TrainingLog::add(const Trainer::Step& step, std::size_t gaussians, const Quality& test) {
  const int done = step.number + 1;
  const double rate = (done - first_step_) / seconds(), in_all_s = before_s_ + seconds();
  if (terminal_) fmt::print(stderr, "\r{:<79}\r", "");
  fmt::print("{:>8} {:>9.5f} {:>11} {:>9.2f} {:>8.5f} {:>9.0f} {:>8.1f} {:>8.0f}\n", done,
             step.loss, grouped(gaussians), test.psnr_db, test.ssim, in_all_s, rate,
             (steps_ - done) / rate);
  std::fflush(stdout);
  csv_ += fmt::format("{},{:.2f},{:.7g},{},{:.4f},{:.6f}\n", done, in_all_s, step.loss, gaussians,
                      test.psnr_db, test.ssim);
}

}  // namespace sgs
