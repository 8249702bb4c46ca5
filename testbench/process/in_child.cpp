// Fork, run, and a pipe for the answer.
#include "testbench/process/in_child.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace sgs {
namespace {

void write_all(int descriptor, const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor, at, bytes);
    if (written <= 0) throw std::runtime_error("cannot hand the result to the parent process");
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

bool read_all(int descriptor, void* into, std::size_t bytes) {
  char* at = static_cast<char*>(into);
  while (bytes > 0) {
    const ssize_t got = ::read(descriptor, at, bytes);
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

// Without destructors: those of a simulation that was cut short could not be trusted.
[[noreturn]] void child(const char* program, const std::function<std::string()>& work,
                        int answer_to) {
  int status = EXIT_SUCCESS;
  try {
    const std::string result = work();
    const std::uint64_t bytes = result.size();
    write_all(answer_to, &bytes, sizeof bytes);
    write_all(answer_to, result.data(), result.size());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    status = EXIT_FAILURE;
  }
  std::fflush(nullptr);
  ::_exit(status);
}

}  // namespace

ChildEnd in_child(const char* program, const std::function<std::string()>& work,
                  std::string& result) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe to a child process");
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot start a child process");
  if (process == 0) {
    ::close(ends[0]);
    child(program, work, ends[1]);
  }
  ::close(ends[1]);
  std::uint64_t bytes = 0;
  result.clear();
  if (read_all(ends[0], &bytes, sizeof bytes)) {
    result.resize(bytes);
    if (!read_all(ends[0], result.data(), bytes)) result.clear();
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(process, &status, 0);
  if (WIFSIGNALED(status)) return {-WTERMSIG(status)};
  return {WEXITSTATUS(status)};
}

}  // namespace sgs
