// Lanes in Verilog, to which a step a cycle is given.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "Vfp16_lane.h"
#include "Vfp32_lane.h"
#include "modules/datapath/lane_steps.h"
#include "tests/modules/datapath/rtl/vectors.h"

namespace sgs::test {

struct LaneInput {
  float a, b, c;
  bool unrounded = false;
};
struct LaneOutput {
  float product, sum;
};

// What leaves a lane, a cycle each, in the order of what went in. `cycles`: from a, b and c to the
// sum; the product is there a cycle earlier. Clock: gives the lane a cycle; Read: what is there.
template <class Clock, class Product, class Sum>
std::vector<LaneOutput> through_lane(const std::vector<LaneInput>& inputs, std::size_t cycles,
                                     const Clock& clock, const Product& product, const Sum& sum) {
  std::vector<LaneOutput> outputs(inputs.size());
  for (std::size_t cycle = 0; cycle < inputs.size() + cycles - 1; ++cycle) {
    clock(inputs[std::min(cycle, inputs.size() - 1)]);
    const std::size_t added = cycle + 1 - cycles, multiplied = added + 1;
    if (multiplied < inputs.size()) outputs[multiplied].product = product();
    if (added < inputs.size()) outputs[added].sum = sum();
  }
  return outputs;
}

inline std::vector<LaneOutput> through_fp32_lane(const std::vector<LaneInput>& inputs) {
  const auto lane = std::make_unique<Vfp32_lane>();
  const auto clock = [&](const LaneInput& in) {
    lane->a = bits_of(in.a);
    lane->b = bits_of(in.b);
    lane->c = bits_of(in.c);
    lane->unrounded = in.unrounded;
    lane->clock = 0;
    lane->eval();
    lane->clock = 1;
    lane->eval();
  };
  return through_lane(
      inputs, OperationLatencies{}.lane, clock, [&] { return float_of(lane->product); },
      [&] { return float_of(lane->sum); });
}

// kHalfLaneCycles: half_lane_latency_cycles of the machines.
constexpr std::size_t kHalfLaneCycles = 2;
inline std::vector<LaneOutput> through_fp16_lane(const std::vector<LaneInput>& inputs) {
  const auto lane = std::make_unique<Vfp16_lane>();
  const auto clock = [&](const LaneInput& in) {
    lane->a = half_bits_of(in.a);
    lane->b = half_bits_of(in.b);
    lane->c = half_bits_of(in.c);
    lane->clock = 0;
    lane->eval();
    lane->clock = 1;
    lane->eval();
  };
  return through_lane(
      inputs, kHalfLaneCycles, clock, [&] { return half_of(lane->product); },
      [&] { return half_of(lane->sum); });
}

}  // namespace sgs::test
