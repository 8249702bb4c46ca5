// Ctrl-C, or a request to end, as a wish that a job may look at between two of its steps.
#pragma once

namespace sgs {

// While one lives, SIGINT and SIGTERM set it once; a second one ends the program as ever.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool wished() const;
};

constexpr int kInterrupted = 130;  // exit status

}  // namespace sgs
