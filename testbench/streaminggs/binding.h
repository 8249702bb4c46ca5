// Which resource limits a frame, and how far the next one is.
#pragma once

#include <string>
#include <vector>

#include "testbench/result/frame_result.h"

namespace sgs {

// A resource's share of the frame in which it worked, 0 to 1: that of its busiest activity.
struct ResourceUse {
  std::string name;
  double utilisation = 0;
  std::string waits;  // for what, when it does not work
};

// Every resource that an activity names, in the order of the data sheets, and the memory's data
// buses.
std::vector<ResourceUse> resource_uses(const FrameResult& frame);

struct Binding {
  std::string unit, next;  // the busiest resource, and the one after it
  double utilisation = 0, next_utilisation = 0;
  std::string explanation;  // a sentence with the numbers
};

Binding find_binding(const FrameResult& frame);

}  // namespace sgs
