// The name that --out gives a file: its ending says the form of what is written.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "algorithm/files/input_error.h"

namespace sgs {

// Throws InputError where the name ends in another way, as that of a folder would.
inline void check_output_name(const std::string& out, const char* ending) {
  if (std::filesystem::path(out).extension() == ending) return;
  throw InputError(fmt::format("--out: {}, expected a name that ends in {}", out, ending));
}

}  // namespace sgs
