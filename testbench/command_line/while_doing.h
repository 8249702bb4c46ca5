// Out of memory, and over what.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

namespace sgs {

// Returns work(). Where memory does not suffice, throws std::runtime_error that names `what`, for
// example "reading truck.ply".
template <class Work>
auto while_doing(const std::string& what, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("out of memory while " + what);
  }
}

}  // namespace sgs
