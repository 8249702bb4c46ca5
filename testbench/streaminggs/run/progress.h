// Progress of a long job, on a terminal only.
#pragma once

#include <chrono>
#include <string>

#include "algorithm/vq/quantise.h"

namespace sgs {

// A line of stderr, rewritten with each news and wiped when the job is done; nothing where
// stderr is no terminal.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void say(const std::string& line) const;
  bool on_terminal() const { return terminal_; }

  // For the time of this object.
  VqProgress of_quantisation() const;

 private:
  const bool terminal_;
};

inline double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace sgs
