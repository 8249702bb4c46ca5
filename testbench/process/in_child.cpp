// Fork, run, and a pipe for the answer.
#include "testbench/process/in_child.h"

#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include "algorithm/input_error.h"

namespace sgs {
namespace {

enum class Answer : char { kResult, kFailure, kRefusal };

int answer_to = -1;  // of a child: its end of the pipe

bool write_all(const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t written = ::write(answer_to, at, bytes);
    if (written <= 0) return false;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

// Without destructors: those of a simulation that was cut short could not be trusted.
[[noreturn]] void answer(Answer kind, const std::string& text) {
  const std::uint64_t bytes = text.size();
  const bool written = write_all(&kind, sizeof kind) && write_all(&bytes, sizeof bytes) &&
                       write_all(text.data(), text.size());
  std::fflush(nullptr);
  ::_exit(written && kind == Answer::kResult ? EXIT_SUCCESS : EXIT_FAILURE);
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

// A child has only the thread that forked, and waits for ever for a lock that another one held.
void end_worker_threads() {
  tbb::task_scheduler_handle workers{tbb::attach{}};
  tbb::finalize(workers, std::nothrow);
}

[[noreturn]] void child(const std::function<std::string()>& work) {
  try {
    answer(Answer::kResult, work());
  } catch (const std::bad_alloc&) {
    fail_child("out of memory in the simulation");
  } catch (const InputError& error) {
    answer(Answer::kRefusal, one_line(error.what()));
  } catch (const std::exception& error) {
    fail_child(error.what());
  }
}

}  // namespace

void fail_child(const std::string& why) { answer(Answer::kFailure, one_line(why)); }

std::string in_child(const std::function<std::string()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe to a child process");
  std::fflush(nullptr);
  end_worker_threads();
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot start a child process");
  if (process == 0) {
    ::close(ends[0]);
    answer_to = ends[1];
    child(work);
  }
  ::close(ends[1]);
  Answer kind = Answer::kFailure;
  std::uint64_t bytes = 0;
  std::string text;
  bool complete = read_all(ends[0], &kind, sizeof kind) && read_all(ends[0], &bytes, sizeof bytes);
  if (complete) {
    text.resize(bytes);
    complete = read_all(ends[0], text.data(), bytes);
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(process, &status, 0);
  if (WIFSIGNALED(status)) {
    throw std::runtime_error("the simulation was ended by signal " +
                             std::to_string(WTERMSIG(status)));
  }
  if (!complete) {
    throw std::runtime_error("the simulation ended with exit status " +
                             std::to_string(WEXITSTATUS(status)));
  }
  if (kind == Answer::kRefusal) throw InputError(text);
  if (kind == Answer::kFailure) throw std::runtime_error(text);
  return text;
}

}  // namespace sgs
