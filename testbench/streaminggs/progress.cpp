// One line, rewritten.
#include "testbench/streaminggs/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace sgs {

VqProgress quantisation_progress() {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [](Codebook codebook, std::uint32_t iteration, double error) {
    const bool last = error == 0;
    fmt::print(stderr, "\r{:<10} codebook: iteration {:>3}, mean squared error {:<12.4g}{}",
               kCodebookNames[static_cast<std::size_t>(codebook)], iteration, error,
               last ? "\n" : "");
    std::fflush(stderr);
  };
}

}  // namespace sgs
