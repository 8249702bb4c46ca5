// Sums of streaming statistics.
#include "algorithm/render/render_result.h"

#include <algorithm>

namespace sgs {

StreamingStats& StreamingStats::operator+=(const StreamingStats& other) {
  using Count = std::uint64_t StreamingStats::*;
  for (const Count count :
       {&StreamingStats::groups, &StreamingStats::visits, &StreamingStats::visits_saturated,
        &StreamingStats::blocks_reached, &StreamingStats::first_halves,
        &StreamingStats::coarse_passed, &StreamingStats::second_halves, &StreamingStats::fine_tests,
        &StreamingStats::splats, &StreamingStats::subtile_blends, &StreamingStats::contributors,
        &StreamingStats::contributing, &StreamingStats::misordered, &StreamingStats::missed,
        &StreamingStats::ray_steps, &StreamingStats::edges_offered, &StreamingStats::nodes_read,
        &StreamingStats::forced_early}) {
    this->*count += other.*count;
  }
  for (const Count largest : {&StreamingStats::table_bytes_max, &StreamingStats::visit_splats_max,
                              &StreamingStats::pending_keys_max}) {
    this->*largest = std::max(this->*largest, other.*largest);
  }
  return *this;
}

}  // namespace sgs
