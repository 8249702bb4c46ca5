#include "testbench/streaminggs/fitting_log.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "testbench/streaminggs/numbers.h"

namespace sgs {
namespace {

constexpr const char* kCsvHead = "step,seconds,loss,gaussians,test_psnr_db,test_ssim";

// Of the last line; 0 where there is none.
double seconds_of(const std::string& csv) {
  const std::size_t line = csv.rfind('\n', csv.size() - 2) + 1;
  const std::size_t comma = csv.find(',', line);
  return comma == std::string::npos ? 0 : std::strtod(csv.c_str() + comma + 1, nullptr);
}

}  // namespace

FittingLog::FittingLog(int steps, std::vector<LogColumn> more, std::string csv)
    : steps_(steps), terminal_(::isatty(STDERR_FILENO) != 0), csv_(std::move(csv)) {
  if (csv_.empty()) {
    csv_ = kCsvHead;
    for (const LogColumn& column : more) csv_ += fmt::format(",{}", column.csv);
    csv_ += '\n';
  } else {
    before_s_ = seconds_of(csv_);
  }
  fmt::print("{:>8} {:>9} {:>11} {:>9} {:>8}", "step", "loss", "Gaussians", "test PSNR", "SSIM");
  for (const LogColumn& column : more) fmt::print(" {:>10}", column.heading);
  fmt::print(" {:>9} {:>8} {:>8}\n", "seconds", "steps/s", "left s");
}

double FittingLog::seconds() const {
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
  return took.count();
}

void FittingLog::tell(const FittingStep& step, std::size_t gaussians) {
  if (first_step_ < 0) first_step_ = step.number;
  if (!terminal_) return;
  const double rate = (step.number + 1 - first_step_) / seconds();
  fmt::print(stderr, "\r{:<79}\r",
             fmt::format("step {} of {}, loss {:.4f}, {} Gaussians, {:.1f} steps/s, {:.0f} s left",
                         step.number + 1, steps_, step.loss, grouped(gaussians), rate,
                         (steps_ - step.number - 1) / rate));
}

void FittingLog::add(int done, std::optional<double> loss, std::size_t gaussians,
                     const Look& look) {
  const double in_all_s = before_s_ + seconds();
  if (terminal_) fmt::print(stderr, "\r{:<79}\r", "");
  fmt::print("{:>8} {:>9} {:>11} {:>9.2f} {:>8.5f}", done,
             loss ? fmt::format("{:.5f}", *loss) : "-", grouped(gaussians), look.test.psnr_db,
             look.test.ssim);
  for (const double value : look.more) fmt::print(" {:>10.4g}", value);
  if (first_step_ < 0) {
    fmt::print(" {:>9.0f} {:>8} {:>8}\n", in_all_s, "-", "-");
  } else {
    const double rate = (done - first_step_) / seconds();
    fmt::print(" {:>9.0f} {:>8.1f} {:>8.0f}\n", in_all_s, rate, (steps_ - done) / rate);
  }
  std::fflush(stdout);
  csv_ += fmt::format("{},{:.2f},{},{},{:.4f},{:.6f}", done, in_all_s,
                      loss ? fmt::format("{:.7g}", *loss) : "", gaussians, look.test.psnr_db,
                      look.test.ssim);
  for (const double value : look.more) csv_ += fmt::format(",{:.7g}", value);
  csv_ += '\n';
}

}  // namespace sgs
