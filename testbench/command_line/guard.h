// The frame of every executable's main(): streams, errors, exit status.
#pragma once

#include <functional>
#include <string>

namespace sgs {

constexpr int kDone = 0;
constexpr int kFailed = 1;    // the run failed or a check did not hold
constexpr int kBadInput = 2;  // arguments, files or configurations that cannot be used

// Returns what `body` does. Whatever it throws becomes one line on stderr that begins with the name
// of the program, and an exit status; so does standard output that could not be written. A signal
// that ends the program removes the temporaries of its outputs.
int run_guarded(const std::string& program, const std::function<int()>& body);

}  // namespace sgs
