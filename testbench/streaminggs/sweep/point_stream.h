// Points that come line by line while others are simulated.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/streaminggs/sweep/sweep_points.h"

namespace sgs {

// A point says what it differs in; what is longer is no text that anybody wrote.
constexpr std::size_t kLongestLineBytes = 1'000'000;

// Reads points from a file descriptor, which poll() can wait for.
class PointStream {
 public:
  explicit PointStream(int descriptor) : descriptor_(descriptor) {}

  int descriptor() const { return descriptor_; }
  bool ended() const { return ended_; }

  // Reads once, what is there or, where nothing is, when it comes: the points of the lines that are
  // complete. A line that is none is a refused point: who sent it waits for an answer. One longer
  // than kLongestLineBytes is refused when so much of it has come, and the rest of it dropped.
  std::vector<SweepPoint> receive();

 private:
  void take(std::string_view piece, std::vector<SweepPoint>& points);
  void end_line(std::vector<SweepPoint>& points);
  std::string place() const;

  const int descriptor_;
  bool ended_ = false;
  std::string line_;       // as much of it as has come
  bool too_long_ = false;  // and refused: what still comes of it is dropped
  int number_ = 1;         // the line's number
};

}  // namespace sgs
