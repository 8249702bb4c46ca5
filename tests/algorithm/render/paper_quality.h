// What paper order loses on real scenes, against ranges that an independent prototype measured.
#pragma once

#include <string>

namespace sgs::test {

struct PsnrRange {
  double low_db, high_db;  // worst and best view
};

struct PaperScene {
  std::string name;
  float voxel_size;          // world units
  PsnrRange prototype;       // against the reference, group 64
  PsnrRange first_met;       // ours: ties go to the voxel that a ray met first
  double first_k, second_k;  // the prototype's halves read, thousands, mean over the views
};

// Renders every view at group 64 with both rules for ties. With the nearest voxel first the worst
// and the best view must lie within 1 dB of the prototype's, with ours within 0.1 dB of what is
// written here: nothing but the rule may lie between them. Prints the counts of halves beside the
// prototype's.
void check_paper_quality(const PaperScene& scene);

}  // namespace sgs::test
