// The folder, from the executable's own place.
#include "algorithm/files/data_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  return (program.parent_path() / SGS_DATA_FROM_BIN).lexically_normal();
}

}  // namespace

std::string data_file(const std::string& name) { return (data_folder() / name).string(); }

void require_data_files() {
  std::error_code missing;
  if (fs::is_directory(data_folder(), missing)) return;
  throw InputError(
      fmt::format("{}: not there, expected the presets, memspecs and tables that are installed "
                  "with the program",
                  data_folder().string()));
}

}  // namespace sgs
