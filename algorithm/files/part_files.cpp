// A table that a signal handler may read.
#include "algorithm/files/part_files.h"

#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

namespace sgs {
namespace {

std::array<std::atomic<const char*>, 256> parts;
pid_t owner = 0;

// Nothing but what a handler may call.
extern "C" void remove_parts(int signal) {
  if (::getpid() == owner) {
    for (const auto& part : parts) {
      if (const char* path = part.load()) ::unlink(path);
    }
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

// The first place that holds `from` holds `to`.
void exchange(const char* from, const char* to) {
  for (auto& part : parts) {
    const char* expected = from;
    if (part.compare_exchange_strong(expected, to)) return;
  }
}

}  // namespace

void remember_part(const char* path) { exchange(nullptr, path); }
void forget_part(const char* path) { exchange(path, nullptr); }

void remove_parts_on_signals() {
  owner = ::getpid();
  for (const int signal : {SIGINT, SIGTERM}) {
    if (std::signal(signal, remove_parts) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace sgs
