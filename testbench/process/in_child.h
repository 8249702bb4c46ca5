// A job in a process of its own: the SystemC kernel elaborates once a process.
#pragma once

#include <functional>
#include <string>

namespace sgs {

// Runs work() in a forked child and returns what it returns. Throws as ChildProcess does.
std::string in_child(const std::function<std::string()>& work);

}  // namespace sgs
