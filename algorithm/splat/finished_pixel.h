// From the state of a pixel to the frame: what leaves the pixels on chip.
#pragma once

#include <cmath>

#include "algorithm/splat/scalar.h"

namespace sgs {

// One channel of C + T background.
template <class T>
T over_background(T colour, T transmittance, T background) {
  return T(colour + transmittance * background);
}

// A channel as a whole number of 8 bits.
template <class T>
T level_of(T channel) {
  using std::round;
  return T(round(T(T(255.0F) * clamp_of(channel, T(0.0F), T(1.0F)))));
}

}  // namespace sgs
