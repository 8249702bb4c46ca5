// A part of a frame in which some activities run and the others cannot. Parts follow each other
// where one makes in memory all that the next one reads.
#pragma once

#include <vector>

#include "tlm/activity.h"

namespace sgs {

// Activities that belong to none are part of every phase. Made before them, not running.
class Phase {
 public:
  // Waits only for the phase, from now until begin().
  void add(Activity& activity) {
    activities_.push_back(&activity);
    activity.leaves_phase();
  }

  void begin() {
    for (Activity* activity : activities_) activity->enters_phase();
  }
  void end() {
    for (Activity* activity : activities_) activity->leaves_phase();
  }

 private:
  std::vector<Activity*> activities_;
};

}  // namespace sgs
