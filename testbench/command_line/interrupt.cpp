#include "testbench/command_line/interrupt.h"

#include <csignal>

namespace sgs {
namespace {

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

Interrupt::Interrupt() {
  wished_now = 0;
  for (Caught& c : caught) c.before = std::signal(c.signal, note_wish);
}
Interrupt::~Interrupt() { put_back(); }
bool Interrupt::wished() const { return wished_now != 0; }

}  // namespace sgs
