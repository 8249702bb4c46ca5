// Work in a process of its own: the SystemC kernel elaborates once a process.
#pragma once

#include <functional>
#include <string>

namespace sgs {

// Runs work() in a forked child and returns what it returns. Throws the InputError that the child
// threw, in one line, and std::runtime_error when no
// process can be had, and when the child failed: with what() of the std::exception it threw, with
// what it gave to fail_child(), or with the signal or exit status that ended it, in one line.
std::string in_child(const std::function<std::string()>& work);

// For a child that cannot throw where it stands: ends it at once, and in_child() throws `why`.
[[noreturn]] void fail_child(const std::string& why);

}  // namespace sgs
