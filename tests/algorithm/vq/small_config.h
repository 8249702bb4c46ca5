// Codebooks so small that every entry has many Gaussians.
#pragma once

#include "algorithm/vq/quantise.h"

namespace sgs::test {

inline VqConfig small_config() {
  VqConfig config;
  config.scale_entries = 40;
  config.rotation_entries = 60;
  config.dc_entries = 30;
  config.sh_entries = 20;
  config.iterations = 5;
  return config;
}

}  // namespace sgs::test
