// Whether two vectors of trivial values are equal byte by byte, so that -0 and 0 differ.
#pragma once

#include <cstring>
#include <vector>

namespace sgs::test {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace sgs::test
