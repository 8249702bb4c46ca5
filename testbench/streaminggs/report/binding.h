// Which resource limits a frame, how far the next one is, and what to change.
#pragma once

#include <string>
#include <vector>

#include "testbench/cost/cost.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// A resource's share of the frame in which it worked, 0 to 1: that of its busiest activity.
struct ResourceUse {
  std::string name;
  double utilisation = 0;
  Remedy remedy;  // for more of it
};

// Every resource that an activity names, in the order of the data sheets, and the memory's data
// buses.
std::vector<ResourceUse> resource_uses(const FrameResult& frame);

// The cause of an activity's waiting, found from one end of a FIFO to the other: a busy activity,
// or a place at which the last one waits.
struct Cause {
  std::vector<std::string> path;  // activities, from the one that waits
  std::string holds;              // an activity, a FIFO, a port or a unit
  std::string why;  // the last one's "works 62 % of the frame", "answers to its reads"
  Remedy remedy;
};

// From the busiest activity on, of the longest phase where phases follow each other, each time to
// the other end of the FIFO at which the most cycles are lost, until one is reached that fills its
// phase, whose own waiting explains less than half of that (it works instead), that waits for
// memory, or that waits for one that was met before: then the FIFO between the two holds both.
Cause follow_waiting(const FrameResult& frame);

struct Binding {
  std::string unit, next;  // the busiest resource, and the one after it
  double utilisation = 0, next_utilisation = 0;
  std::string holds;  // the resource, or where nothing is busy the cause
  Remedy remedy;      // for `holds`; where none is known, for the resource
  std::string explanation, advice;

  // With the numbers, and what to change.
  std::string sentence() const { return explanation + "; " + advice; }
};

Binding find_binding(const FrameResult& frame);

// The same; where it advises more channels of the memory, it says what twice as many add to `area`,
// the frame's.
Binding find_binding(const FrameResult& frame, const Totals& area);

// The same of a frame whose picture is empty: nothing of the configuration is to blame.
Binding without_advice(Binding binding);

}  // namespace sgs
