// sc_start(), and the stack it returns to.
#include "tlm/run_simulation.h"

#include <systemc>

#ifdef __SANITIZE_ADDRESS__
#include <pthread.h>
#include <sanitizer/common_interface_defs.h>
#endif

namespace sgs {
namespace {

// SystemC 2.3.4 tells AddressSanitizer of each switch to another stack, but not where the first one
// lies. An exception would then not clear the marks of the frames that it leaves. The next
// functions there would be taken for writers out of bounds.
void declare_main_stack() {
#ifdef __SANITIZE_ADDRESS__
  pthread_attr_t attributes;
  void* bottom = nullptr;
  std::size_t bytes = 0;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return;
  pthread_attr_getstack(&attributes, &bottom, &bytes);
  pthread_attr_destroy(&attributes);
  __sanitizer_start_switch_fiber(nullptr, bottom, bytes);
  __sanitizer_finish_switch_fiber(nullptr, nullptr, nullptr);
#endif
}

}  // namespace

void run_simulation() {
  sc_core::sc_start();
  declare_main_stack();
}

void run_simulation_until(const sc_core::sc_time& time) {
  sc_core::sc_start(time - sc_core::sc_time_stamp());
  declare_main_stack();
}

}  // namespace sgs
