// The floor below which a change of a frame's cycles or joules says nothing of a part (README.md).
#pragma once

#include <cmath>

namespace sgs {

constexpr double kFrameNoise = 0.005;  // share of the frame's cycles, or of its joules
constexpr const char* kBelowNoise = "below the noise of a frame";

// change: as such a share. Where there is none, that is certain.
inline bool below_noise(double change) { return change != 0 && std::abs(change) < kFrameNoise; }

}  // namespace sgs
