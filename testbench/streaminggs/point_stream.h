// Points that come line by line while others are simulated.
#pragma once

#include <string>
#include <vector>

#include "testbench/streaminggs/sweep_points.h"

namespace sgs {

// Of a file descriptor, for poll().
class PointStream {
 public:
  explicit PointStream(int descriptor) : descriptor_(descriptor) {}

  int descriptor() const { return descriptor_; }
  bool ended() const { return ended_; }

  // Reads once, what is there or, where nothing is, when it comes: the points of the lines that are
  // complete. A line that is none is a refused point: who sent it waits for an answer.
  std::vector<SweepPoint> receive();

 private:
  void add(const std::string& line, std::vector<SweepPoint>& points);

  const int descriptor_;
  bool ended_ = false;
  std::string rest_;  // of a line that has not come whole
  int lines_ = 0;
};

}  // namespace sgs
