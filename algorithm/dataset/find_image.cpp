// The search of find_image.h.
#include "algorithm/dataset/find_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "algorithm/image/photograph.h"
#include "algorithm/input_error.h"
#include "algorithm/join.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 6> kExtensions = {".png", ".jpg", ".jpeg",
                                                    ".PNG", ".JPG", ".JPEG"};

bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown) && !fs::is_directory(path, unknown);
}

std::vector<std::string> files_of(const std::vector<std::string>& folders,
                                  const std::string& name) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    const std::string path = (fs::path(folder) / name).lexically_normal().string();
    const bool known = std::find(found.begin(), found.end(), path) != found.end();
    if (is_there(path) && !known) found.push_back(path);  // an absolute name is in every folder
  }
  return found;
}

}  // namespace

FoundImage find_image(const std::vector<std::string>& folders, const std::string& name,
                      const std::string& where) {
  std::vector<std::string> found = files_of(folders, name);
  if (found.empty()) {
    for (const char* extension : kExtensions) {
      for (std::string& path : files_of(folders, name + extension)) {
        found.push_back(std::move(path));
      }
    }
  }
  if (found.empty()) {
    throw InputError(fmt::format(
        "{}: no image '{}' in {}, expected it there, or with .png, .jpg or .jpeg behind", where,
        name, join(folders, " or ")));
  }
  if (found.size() > 1) {
    throw InputError(fmt::format("{}: image '{}': got {}, expected one of them", where, name,
                                 join(found, " and ")));
  }
  return {found[0], read_photograph_header(found[0])};
}

std::string view_name(const std::string& name) {
  fs::path path = fs::path(name).lexically_normal();
  const std::string extension = path.extension().string();
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end()) {
    path.replace_extension();
  }
  return path.string();
}

}  // namespace sgs
