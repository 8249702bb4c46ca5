// Exact order through the whole accelerator, under configurations that hurt it.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace sgs::test {

// --set options at random: group, chunk, merge buffer and walk queue from next to nothing to
// roomy, numbers of units, FIFOs; with SRAM for all of them. Every other time also stalls.
std::vector<std::string> random_exact_options(std::mt19937_64& random);

// Random hard scenes (needles, giants, points, coincident centres, equal depths, the near plane,
// coordinates of 10^6) with random options: frame = reference, accounts add up.
void fuzz_exact_frames(unsigned first_seed, unsigned scenes);

// Every view of a scene of ../shared with tiny buffers and queues, and stalls.
void check_exact_under_pressure(const std::string& name);

}  // namespace sgs::test
