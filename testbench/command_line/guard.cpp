// Streams and catching of guard.h.
#include "testbench/command_line/guard.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"

namespace sgs {

namespace {

// A stream that the caller has closed must not become the number of the next file that is opened:
// what is printed would land in that file. Writing to the stand-in is an error, as it should be.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) ::open("/dev/null", O_RDONLY);
  }
}

void complain(const std::string& program, std::string_view message) {
  std::fprintf(stderr, "%s: %s\n", program.c_str(), one_line(message).c_str());
}

int run_and_catch(const std::string& program, const std::function<int()>& body) {
  try {
    return body();
  } catch (const InputError& error) {
    complain(program, error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    complain(program, "out of memory");
  } catch (const std::exception& error) {
    complain(program, error.what());
  }
  return kFailed;
}

struct Caught {
  int signal;
  void (*before)(int) = SIG_DFL;  // its handler until then
};

volatile std::sig_atomic_t wished_now = 0;
Caught caught[] = {{SIGINT}, {SIGTERM}};

void put_back() {
  for (const Caught& c : caught) std::signal(c.signal, c.before);
}

extern "C" void note_wish(int) {
  wished_now = 1;
  put_back();
}

}  // namespace

int run_guarded(const std::string& program, const std::function<int()>& body) {
  occupy_standard_streams();
  remove_parts_on_signals();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is one that cannot be written
  const int status = run_and_catch(program, body);
  std::cout.flush();
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  complain(program, fmt::format("standard output cannot be written{}",
                                errno == 0 ? "" : fmt::format(" ({})", std::strerror(errno))));
  return status == kDone ? kFailed : status;
}

Interrupt::Interrupt() {
  wished_now = 0;
  for (Caught& c : caught) c.before = std::signal(c.signal, note_wish);
}
Interrupt::~Interrupt() { put_back(); }
bool Interrupt::wished() const { return wished_now != 0; }

}  // namespace sgs
