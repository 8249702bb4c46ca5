// The configurations that come with the program.
#pragma once

#include <string>
#include <vector>

namespace sgs {

// Sorted.
std::vector<std::string> preset_names();

// The file behind --config: a preset by its name, any other file by its path. Throws InputError
// that lists the presets when it is neither.
std::string config_file(const std::string& preset_or_path);

}  // namespace sgs
