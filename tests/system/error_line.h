// How a program ends on what is no good: exit status, one line on stderr that begins with the
// program's name, and nothing left that was not there before.
#pragma once

#include <string>
#include <vector>

namespace sgs::test {

struct ErrorLine {
  std::string line;  // for shell()
  int status;
  std::vector<std::string> words;  // in what is said on stderr
  std::string before = "";         // shell line that prepares
};

// Runs it in a folder of its own.
void check(const ErrorLine& row);

}  // namespace sgs::test
