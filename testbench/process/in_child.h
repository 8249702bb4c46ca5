// Work in a process of its own: the SystemC kernel elaborates once a process.
#pragma once

#include <functional>
#include <string>

namespace sgs {

// How a child ended: with an exit status, or by a signal, which is negative here.
struct ChildEnd {
  int status = 0;
  bool by_signal() const { return status < 0; }
};

// Runs work() in a forked child and gives what it returns into `result`, which stays empty unless
// the child came to its end. A child that throws std::exception prints `program: what()` and exits
// with status 1. Throws std::runtime_error when no process can be had.
ChildEnd in_child(const char* program, const std::function<std::string()>& work,
                  std::string& result);

}  // namespace sgs
