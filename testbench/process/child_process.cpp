// Fork, run, and a pipe for the answer: a byte for its kind, and the text.
#include "testbench/process/child_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <systemc>
#include <utility>

#include "algorithm/files/input_error.h"

namespace sgs {

namespace {

enum class Answer : char { kResult, kFailure, kRefusal };

// Before the text: its kind, and how long it is.
constexpr std::size_t kHeadBytes = 1 + sizeof(std::uint64_t);

int answer_to = -1;  // a child's end of the pipe; -1 in the parent

bool write_all(const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t written = ::write(answer_to, at, bytes);
    if (written < 0 && errno == EINTR) continue;
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

// A child has only the thread that forked, and waits for ever for a lock that another one held.
void end_worker_threads() {
  tbb::task_scheduler_handle workers{tbb::attach{}};
  tbb::finalize(workers, std::nothrow);
}

// A parent that was killed can end nobody any more, and nobody would take the answer.
void end_with(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);
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

void handle(const sc_core::sc_report& report, const sc_core::sc_actions& actions) {
  if (report.get_severity() < sc_core::SC_ERROR) {
    sc_core::sc_report_handler::default_handler(report, actions);
    return;
  }
  fail_child(std::string(report.get_msg_type()) + ": " + report.get_msg());
}

}  // namespace

void fail_child(const std::string& why) { answer(Answer::kFailure, one_line(why)); }

ChildProcess::ChildProcess(const std::function<std::string()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe to a child process");
  std::fflush(nullptr);
  end_worker_threads();
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw std::runtime_error("cannot start a child process");
  }
  if (process_ == 0) {
    end_with(parent);
    ::close(ends[0]);
    answer_to = ends[1];
    child(work);
  }
  ::close(ends[1]);
  from_ = ends[0];
}

ChildProcess::~ChildProcess() {
  if (from_ >= 0) ::close(from_);
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  wait_for_end();
}

int ChildProcess::wait_for_end() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

bool ChildProcess::receive() {
  std::array<char, 1U << 16U> block;
  const ssize_t got = ::read(from_, block.data(), block.size());
  if (got < 0 && errno == EINTR) return false;
  if (got <= 0) return true;
  received_.append(block.data(), static_cast<std::size_t>(got));
  return false;
}

std::string ChildProcess::result() {
  while (!receive()) {
  }
  const int status = wait_for_end();
  if (WIFSIGNALED(status)) {
    throw ChildFailure("the simulation was ended by signal " + std::to_string(WTERMSIG(status)));
  }
  std::uint64_t bytes = 0;
  if (received_.size() >= kHeadBytes) std::memcpy(&bytes, received_.data() + 1, sizeof bytes);
  if (received_.size() < kHeadBytes || received_.size() - kHeadBytes != bytes) {
    throw ChildFailure("the simulation ended with exit status " +
                       std::to_string(WEXITSTATUS(status)));
  }
  const auto kind = static_cast<Answer>(received_.front());
  std::string text = std::move(received_);
  text.erase(0, kHeadBytes);
  if (kind == Answer::kRefusal) throw InputError(text);
  if (kind == Answer::kFailure) throw ChildFailure(text);
  return text;
}

std::string in_child(const std::function<std::string()>& work) {
  return ChildProcess(work).result();
}

void fail_child_on_sc_error() { sc_core::sc_report_handler::set_handler(handle); }

}  // namespace sgs
