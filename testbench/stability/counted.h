// What a formula takes, by running it with the counting scalar.
#pragma once

#include <string>
#include <utility>

#include "algorithm/splat/counting.h"

namespace sgs {

// "6 x, 2 +": of formula(inputs...), as many inputs as there are values.
std::string in_words(const OperationCounts& counts);

template <class Formula, class... Values>
std::string counted(const Formula& formula, Values... values) {
  DataFlow flow;
  static_cast<void>(formula(input(flow, values)...));
  return in_words(flow.counts(0, flow.size()));
}

}  // namespace sgs
