#include "testbench/command_line/interrupt.h"

#include <csignal>

namespace sgs {
namespace {

volatile std::sig_atomic_t wished_now = 0;
void (*before)(int) = SIG_DFL;  // what SIGINT did

extern "C" void note_wish(int) {
  wished_now = 1;
  std::signal(SIGINT, before);
}

}  // namespace

Interrupt::Interrupt() {
  wished_now = 0;
  before = std::signal(SIGINT, note_wish);
}
Interrupt::~Interrupt() { std::signal(SIGINT, before); }
bool Interrupt::wished() const { return wished_now != 0; }

}  // namespace sgs
