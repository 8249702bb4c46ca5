// Every view of a scene of ../shared through the accelerator.
#pragma once

#include <string>
#include <vector>

namespace sgs::test {

// Options of one run over all views.
using Variant = std::vector<std::string>;

inline const Variant kPlain = {};
inline const Variant kStalled = {"--stalls", "0.05"};

// Each view equals the streaming renderer's frame (in exact order also the reference's) to the bit,
// and its accounts add up. preset: of the configuration.
void check_shared_scene(const std::string& name, const std::string& preset,
                        const std::vector<Variant>& variants);

}  // namespace sgs::test
