// One line, rewritten.
#include "testbench/streaminggs/run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace sgs {

namespace {

// Over whatever stood there; the cursor stays at its beginning.
void rewrite(const std::string& line) {
  constexpr int kWidth = 79;
  fmt::print(stderr, "\r{:<{}}\r", line, kWidth);
  std::fflush(stderr);
}

}  // namespace

ProgressLine::ProgressLine() : terminal_(::isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (terminal_) rewrite("");
}

void ProgressLine::say(const std::string& line) const {
  if (terminal_) rewrite(line);
}

VqProgress ProgressLine::of_quantisation() const {
  if (!terminal_) return {};
  return [](Codebook codebook, std::uint32_t iteration, double error) {
    rewrite(fmt::format("{} codebook: iteration {}, mean squared error {:.4g}",
                        kCodebookNames[static_cast<std::size_t>(codebook)], iteration, error));
  };
}

}  // namespace sgs
