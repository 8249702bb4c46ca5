// Rendering's feedback: one bit a pixel group, set when nothing can change the group any more. VSU
// and HFU read it and drop what is left of the group.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

class SaturationBoard {
 public:
  explicit SaturationBoard(std::size_t groups) : saturated_(groups, 0) {}
  void set(std::uint32_t group) { saturated_[group] = 1; }
  bool saturated(std::uint32_t group) const { return saturated_[group] != 0; }

 private:
  std::vector<std::uint8_t> saturated_;
};

}  // namespace sgs
