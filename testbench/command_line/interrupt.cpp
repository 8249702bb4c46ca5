#include "testbench/command_line/interrupt.h"

#include <csignal>

namespace sgs {
namespace {

volatile std::sig_atomic_t wished_now = 0;

extern "C" void note_wish(int) {
  wished_now = 1;
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

Interrupt::Interrupt() {
  wished_now = 0;
  std::signal(SIGINT, note_wish);
}
Interrupt::~Interrupt() { std::signal(SIGINT, SIG_DFL); }
bool Interrupt::wished() const { return wished_now != 0; }

}  // namespace sgs
