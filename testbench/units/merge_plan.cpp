// Making of visits, and their order by std::sort.
#include "testbench/units/merge_plan.h"

#include <algorithm>

#include "testbench/units/random_scene.h"

namespace sgs::tb {

StreamingJob merge_job(const MergePlan& plan) {
  const std::uint64_t spill_bytes = 2ULL * plan.slots * kKeyBytes;
  return frame_job(16 * static_cast<int>(plan.groups.size()), 16, square_of(16), FrameFormat::kRgb8,
                   spill_bytes);
}

std::uint32_t longest_visit(const MergePlan& plan) {
  std::size_t longest = 0;
  for (const MergeGroup& group : plan.groups) {
    for (const MergeVisit& visit : group.visits) longest = std::max(longest, visit.keys.size());
  }
  return static_cast<std::uint32_t>(longest);
}

FineCandidate candidate(std::uint32_t group, std::uint32_t visit, const MergeKey& key) {
  FineCandidate c;
  c.group = group;
  c.visit = visit;
  c.slot = key.slot;
  c.depth = key.depth;
  // Anything that must arrive as it left.
  c.mean_x = static_cast<float>(key.slot) + 0.25F;
  c.mean_y = -c.mean_x;
  c.mean_z = key.depth + 1;
  c.carried = {key.slot * 2654435761U, ~key.slot};
  return c;
}

std::vector<MergeKey> expected_order(const MergePlan& plan, const MergeGroup& group) {
  const auto in_order = [](const MergeKey& a, const MergeKey& b) {
    return a.depth < b.depth || (a.depth == b.depth && a.slot < b.slot);
  };
  std::vector<MergeKey> waiting, out;
  for (const MergeVisit& visit : group.visits) {
    waiting.insert(waiting.end(), visit.keys.begin(), visit.keys.end());
    if (plan.config.on_overflow == OnOverflow::kSpill) continue;
    std::sort(waiting.begin(), waiting.end(), in_order);
    std::size_t gone = 0;
    while (gone < waiting.size() && (waiting[gone].depth < visit.release_below ||
                                     waiting.size() - gone > plan.config.entries)) {
      out.push_back(waiting[gone++]);
    }
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(gone));
  }
  std::sort(waiting.begin(), waiting.end(), in_order);
  out.insert(out.end(), waiting.begin(), waiting.end());
  return out;
}

MergeGroup random_group(std::mt19937_64& random, const MergePlan& plan, std::uint32_t chunk,
                        std::uint32_t depths) {
  MergeGroup group;
  std::vector<std::uint32_t> firsts;
  for (std::uint32_t slot = 0; slot < plan.slots; slot += chunk) firsts.push_back(slot);
  std::shuffle(firsts.begin(), firsts.end(), random);
  std::uint32_t nearest = 0;
  for (const std::uint32_t first : firsts) {
    MergeVisit visit;
    for (std::uint32_t slot = first; slot < std::min(first + chunk, plan.slots); ++slot) {
      if (random() % 4 == 0) continue;
      const auto depth = nearest + static_cast<std::uint32_t>(random() % (depths - nearest));
      visit.keys.push_back({0.5F + static_cast<float>(depth), slot});
    }
    std::sort(visit.keys.begin(), visit.keys.end(), [](const MergeKey& a, const MergeKey& b) {
      return a.depth < b.depth || (a.depth == b.depth && a.slot < b.slot);
    });
    if (random() % 3 == 0) {
      nearest += static_cast<std::uint32_t>(random() % (1 + (depths - 1 - nearest) / 4));
    }
    visit.release_below = 0.5F + static_cast<float>(nearest);
    group.visits.push_back(visit);
  }
  if (!group.visits.empty())
    group.visits.back().release_below = std::numeric_limits<float>::infinity();
  return group;
}

MergeGroup one_visit(std::uint32_t n, bool tied) {
  MergeGroup group;
  group.visits.emplace_back();
  for (std::uint32_t i = 0; i < n; ++i) {
    group.visits[0].keys.push_back({tied ? 1.0F : 1.0F + static_cast<float>(i), i});
  }
  return group;
}

}  // namespace sgs::tb
