// What every reader of files, arguments and configurations throws on input that it cannot use.
#pragma once

#include <stdexcept>

namespace sgs {

// The message is one line: file, place (offset, line, property or key), what was found, what was
// expected. The executables print it and end with exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sgs
