// A child process that is waited for.
#include "testbench/process/in_child.h"

#include "testbench/process/child_process.h"

namespace sgs {

std::string in_child(const std::function<std::string()>& work) {
  return ChildProcess(work).result();
}

}  // namespace sgs
