// Choices that a configuration may leave to the model: 0 stands for "auto".
#pragma once

#include <string>
#include <vector>

#include "modules/accelerator_config.h"

namespace sgs {

struct AutoChoice {
  std::string key;
  std::uint32_t value;
  std::string why;  // a sentence with the numbers
};

// Fills in group_px and chunk_gaussians where they are 0; says what was chosen and why. Throws
// InputError when not even the smallest group fits the SRAM.
std::vector<AutoChoice> resolve_auto(AcceleratorConfig& config);

}  // namespace sgs
