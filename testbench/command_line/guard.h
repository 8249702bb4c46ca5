// The frame of every executable's main(): streams, errors, exit status.
#pragma once

#include <functional>
#include <new>
#include <stdexcept>
#include <string>

namespace sgs {

constexpr int kDone = 0;
constexpr int kFailed = 1;    // the run failed or a check did not hold
constexpr int kBadInput = 2;  // arguments, files or configurations that cannot be used

// Returns what `body` does. Whatever it throws becomes one line on stderr that begins with the name
// of the program, and an exit status; so does standard output that could not be written. A signal
// that ends the program removes the temporaries of its outputs.
int run_guarded(const std::string& program, const std::function<int()>& body);

// Returns work(). Where memory does not suffice, throws std::runtime_error that names `what`, for
// example "reading truck.ply".
template <class Work>
auto while_doing(const std::string& what, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("out of memory while " + what);
  }
}

// Ctrl-C, or a request to end, as a wish that a job may look at between two of its steps.

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
