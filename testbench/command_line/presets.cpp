// Where presets lie, and their choice.
#include "testbench/command_line/presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "algorithm/files/data_files.h"
#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

fs::path preset_folder() { return data_file("presets"); }

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(preset_folder(), missing)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string config_file(const std::string& preset_or_path) {
  const std::vector<std::string> names = preset_names();
  if (std::find(names.begin(), names.end(), preset_or_path) != names.end()) {
    return (preset_folder() / (preset_or_path + ".json")).string();
  }
  std::error_code missing;
  if (fs::exists(preset_or_path, missing)) return preset_or_path;
  throw InputError(fmt::format("--config {}: no file of that name, and no preset{}one of {}",
                               preset_or_path, then_expected(did_you_mean(preset_or_path, names)),
                               join(names)));
}

}  // namespace sgs
