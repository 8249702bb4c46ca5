// A forked process that works and answers once, beside the one that started it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace sgs {

// A child failed by itself, not because of its input.
class ChildFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ChildProcess {
 public:
  // Runs work() in a forked child. Whatever ends this process ends the child. Throws
  // std::runtime_error when no process can be had.
  explicit ChildProcess(const std::function<std::string()>& work);
  // Ends it, finished or not.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Readable, for poll(), when receive() has something to do.
  int descriptor() const { return from_; }

  // Takes what has come of the answer, and waits where nothing has. Returns true when
  // no more can come.
  bool receive();

  // Returns the result of work() once it has ended; may be called once. Throws the InputError that
  // the child threw, in one line. Throws ChildFailure when it failed, in one line: with what() of
  // the std::exception it threw, with what it gave to fail_child(), or with the signal or exit
  // status that ended it.
  std::string result();

 private:
  int wait_for_end();

  pid_t process_ = -1;
  int from_ = -1;  // this end of the pipe
  std::string received_;
};

// For a child that cannot throw where it stands: ends it at once, and result() throws `why`.
[[noreturn]] void fail_child(const std::string& why);

// Runs work() in a forked child and returns what it returns. Throws as ChildProcess does.
std::string in_child(const std::function<std::string()>& work);

// From now on an error ends the child where it is, and who asks for its result is told what it
// says. Thrown through the stack of a SystemC process it would upset AddressSanitizer, and there is
// nothing to unwind for.
void fail_child_on_sc_error();

}  // namespace sgs
