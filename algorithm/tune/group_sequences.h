// Which splats are blended into which pixels of a frame, and in which order: all that a picture and
// its derivatives need to know of an order of rendering. Made once a step, drawn, and
// differentiated.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/view.h"

namespace sgs {

// In place of a position in GroupSequences::splats: of a Gaussian that has none.
constexpr std::uint32_t kNoSplat = 0xffffffff;

struct GroupSequences {
  int width = 0, height = 0;           // px, of the frame
  std::vector<Splat> splats;           // each Gaussian that may be seen, once
  std::vector<PixelRect> groups;       // they cover the frame; corners on multiples of 4
  std::vector<std::size_t> first;      // [groups + 1] where each group's sequence begins
  std::vector<std::uint32_t> entries;  // positions in splats, in the order of blending

  // The splat of an entry. Those of the next entries are fetched ahead: a group's splats lie all
  // over the frame's, and without it half of the time is waiting.
  const Splat& splat_of(std::size_t entry) const {
    constexpr std::size_t kAhead = 8;
    const Splat& ahead = splats[entries[std::min(entry + kAhead, entries.size() - 1)]];
    __builtin_prefetch(&ahead);
    __builtin_prefetch(&ahead.footprint);
    return splats[entries[entry]];
  }
};

// The reference renderer's: front to back, equal depths by index. 60 B a splat and 4 B for each
// group of 32 x 32 px that it falls on, which nothing bounds.
GroupSequences reference_sequences(const View<float>& view, const ActivatedCloud& cloud);

// The picture: that of the order's renderer, bit for bit, whatever the number of threads.
RenderResult draw(const GroupSequences& sequences, const glm::vec3& background = glm::vec3(0.0F),
                  BlendPrecision precision = BlendPrecision::kSingle);

}  // namespace sgs
