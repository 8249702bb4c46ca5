#include "testbench/streaminggs/fitting/fitting_log.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {

namespace {

constexpr const char* kCsvHead = "step,seconds,loss,gaussians,test_psnr_db,test_ssim";

constexpr const char* kPhotograph = "photograph";

}  // namespace

FittingLog::FittingLog(int steps, std::vector<LogColumn> more, Earlier earlier)
    : steps_(steps),
      terminal_(::isatty(STDERR_FILENO) != 0),
      csv_(std::move(earlier.csv)),
      before_s_(earlier.seconds) {
  if (csv_.empty()) {
    csv_ = kCsvHead;
    for (const LogColumn& column : more) csv_ += fmt::format(",{}", column.csv);
    csv_ += '\n';
  }
  fmt::print("{:>8} {:>9} {:>11} {:>9} {:>8}", "step", "loss", "Gaussians", "test PSNR", "SSIM");
  for (const LogColumn& column : more) fmt::print(" {:>10}", column.heading);
  fmt::print(" {:>9} {:>8} {:>8}\n", "seconds", "steps/s", "left s");
  std::fflush(stdout);
}

double FittingLog::own_seconds() const {
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
  return took.count();
}

void FittingLog::tell(const FittingStep& step, std::size_t gaussians) {
  if (first_step_ < 0) first_step_ = step.number;
  if (!terminal_) return;
  const double rate = (step.number + 1 - first_step_) / own_seconds();
  const std::string psnr =
      test_psnr_db_ ? fmt::format("test {:.2f} dB, ", *test_psnr_db_) : std::string();
  fmt::print(
      stderr, "\r{:<79}\r",
      fmt::format("step {} of {}, loss {:.4f}, {}{} Gaussians, {:.1f} steps/s, {:.0f} s left",
                  step.number + 1, steps_, step.loss, psnr, grouped(gaussians), rate,
                  (steps_ - step.number - 1) / rate));
}

void FittingLog::add(int done, std::optional<double> loss, std::size_t gaussians,
                     const Look& look) {
  const double in_all_s = seconds();
  test_psnr_db_ = look.test.psnr_db;
  if (done == 0) first_psnr_db_ = test_psnr_db_;
  if (terminal_) fmt::print(stderr, "\r{:<79}\r", "");
  fmt::print("{:>8} {:>9} {:>11} {:>9.2f} {:>8.5f}", done,
             loss ? fmt::format("{:.5f}", *loss) : "-", grouped(gaussians), look.test.psnr_db,
             look.test.ssim);
  for (const double value : look.more) fmt::print(" {:>10.4g}", value);
  if (first_step_ < 0) {
    fmt::print(" {:>9.0f} {:>8} {:>8}\n", in_all_s, "-", "-");
  } else {
    const double rate = (done - first_step_) / own_seconds();
    fmt::print(" {:>9.0f} {:>8.1f} {:>8.0f}\n", in_all_s, rate, (steps_ - done) / rate);
  }
  std::fflush(stdout);
  csv_ += fmt::format("{},{:.2f},{},{},{:.4f},{:.6f}", done, in_all_s,
                      loss ? fmt::format("{:.7g}", *loss) : "", gaussians, look.test.psnr_db,
                      look.test.ssim);
  for (const double value : look.more) csv_ += fmt::format(",{:.7g}", value);
  csv_ += '\n';
}

void FittingLog::end() const {
  if (!first_psnr_db_ || !test_psnr_db_ || !(*test_psnr_db_ < *first_psnr_db_)) return;
  fmt::print("the test views are {:.2f} dB worse than before the first step\n",
             *first_psnr_db_ - *test_psnr_db_);
}

void TestPictures::add_to(CommandLine& line) {
  line.file("--pictures", folder,
            "folder for view_N_photograph.png and, of each look at the test views, "
            "view_N_step_STEPS.png");
  line.numbers("--picture-views", views, "numbers of test views for --pictures, as in 0,7");
  line.needs("--picture-views", "--pictures");
}

void TestPictures::add_to(OutputPlan& plan) const {
  if (folder.empty()) return;
  for (const int view : views) plan.add_output(file(view, kPhotograph));
}

void TestPictures::write_photographs(const Photographs& test, const glm::vec3& background) const {
  if (folder.empty()) return;
  for (const int view : views) {
    if (view < 0 || static_cast<std::size_t>(view) >= test.size()) {
      throw InputError(fmt::format("--picture-views: got {}, expected 0 .. {}, the test views",
                                   view, test.size() - 1));
    }
  }
  for (const int view : views) {
    write_image(file(view, kPhotograph), test.before(static_cast<std::size_t>(view), background));
  }
}

PictureSeen TestPictures::behind(int steps) const {
  if (folder.empty()) return {};
  return [this, steps](std::size_t at, const Image& picture) {
    const int view = static_cast<int>(at);
    if (std::find(views.begin(), views.end(), view) == views.end()) return;
    write_image(file(view, fmt::format("step_{:06}", steps)), picture);
  };
}

std::string TestPictures::file(int view, const std::string& what) const {
  return (std::filesystem::path(folder) / fmt::format("view_{}_{}.png", view, what)).string();
}

}  // namespace sgs
