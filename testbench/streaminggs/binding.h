// Which resource limits a frame, and how far the next one is.
#pragma once

#include <string>
#include <vector>

namespace sgs {

class Accelerator;
class Activity;

// A resource's share of the frame in which it worked; of several alike, the busiest.
struct ResourceUse {
  std::string name;
  double utilisation = 0;              // 0 to 1
  const Activity* activity = nullptr;  // whose share it is; null for the memory
};

// VSU, coarse filters, decoding, fine filters, sorting, rendering, draining, the memory's data
// buses.
std::vector<ResourceUse> resource_uses(Accelerator& accelerator);

struct Binding {
  std::string unit, next;
  double utilisation = 0, next_utilisation = 0;
  std::string explanation;  // a sentence with the numbers
};

Binding find_binding(Accelerator& accelerator);

}  // namespace sgs
