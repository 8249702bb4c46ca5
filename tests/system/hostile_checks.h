// One hostile scene through everything that draws, tunes and packs: right, or refused by name.
#pragma once

#include <cstdint>
#include <string>

namespace sgs::test {

struct HostileTotals {
  std::uint64_t cases = 0, frames = 0, refused_scenes = 0, refused_settings = 0;
  std::uint64_t blends = 0, pixels = 0, narrow_pixels = 0;
};

// The case of a seed (hostile_cases.h) and configurations drawn by it:
// - reference renderer and double-precision oracle within the rounding of their formulas, each
//   decision and each pixel (decisions.h, pixel_bounds.h);
// - exact, paper, gscore, gscore_lossless: the frame in DRAM is the golden renderer's, where
// nothing
//   is given away on purpose also the reference's; everything accounted for (frame_checks.h,
//   tile_frame_checks.h);
// - pack, and the packed scene simulated: the frames of the scene itself;
// - a few steps of tune: a scene that can be read, every number finite; or the step and the
//   Gaussian that left the limits, and the last good state.
// Or exit status 2 and one line that names file and property, or a key that was set, and nothing
// written. Fails the test otherwise, with the seed and the command that repeats it.
void check_hostile(std::uint64_t seed, HostileTotals& totals);

std::string to_text(const HostileTotals& totals);

}  // namespace sgs::test
