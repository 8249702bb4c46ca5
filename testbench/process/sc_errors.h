// Errors that SystemC reports in a child process.
#pragma once

namespace sgs {

// From now on an error ends the child where it is, and who asks for its result is told what it
// says. Thrown through the stack of a SystemC process it would upset AddressSanitizer, and there is
// nothing to unwind for.
void fail_child_on_sc_error();

}  // namespace sgs
