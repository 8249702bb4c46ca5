// How the numbers of a frame came about.
#pragma once

#include <cstdint>

namespace sgs {

enum class Fidelity : std::uint8_t {
  kAccurate,  // simulated; the frame was read back from the modelled DRAM
  kEstimate,  // reckoned from what the streaming renderer counted; the frame is that renderer's
};

inline const char* name_of(Fidelity fidelity) {
  return fidelity == Fidelity::kEstimate ? "estimate" : "accurate";
}

}  // namespace sgs
