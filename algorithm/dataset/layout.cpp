#include "algorithm/dataset/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

constexpr std::array<Layout, 5> kLayouts = {{
    {"COLMAP", "colmap", "sparse/0/cameras.bin or .txt", holds_colmap, read_colmap},
    {"NeRF synthetic", "nerf-synthetic", "transforms_train.json", holds_split_transforms,
     read_split_transforms},
    {"transforms.json", "transforms", "transforms.json", holds_transforms, read_transforms},
    {"cameras.json", "cameras", "cameras.json", holds_cameras_json, read_cameras_json},
    {"NSVF", "nsvf", "intrinsics.txt with pose and rgb", holds_nsvf, read_nsvf},
}};
constexpr const Layout& kColmap = kLayouts[0];

void check_folder(const std::string& folder) {
  std::error_code unknown;
  if (std::filesystem::is_directory(folder, unknown)) return;
  const char* got = std::filesystem::exists(folder, unknown) ? "is a file" : "no such folder";
  throw InputError(fmt::format("{}: {}, expected a folder with a data set", folder, got));
}

template <class Field>
std::vector<std::string> each(const std::vector<const Layout*>& layouts, const Field& field) {
  std::vector<std::string> out;
  for (const Layout* layout : layouts) out.emplace_back(field(*layout));
  return out;
}

const char* looked_for_by(const Layout& layout) { return layout.looked_for; }
const char* key_of(const Layout& layout) { return layout.key; }

const Layout& chosen(const std::string& folder, const std::string& key,
                     const std::vector<const Layout*>& all) {
  for (const Layout* layout : all) {
    if (key != layout->key) continue;
    const bool aside = layout == &kColmap && holds_colmap_aside(folder);
    if (layout->holds(folder) || aside) return *layout;
    throw InputError(fmt::format("{}: holds no {}, expected what --layout {} stands for", folder,
                                 layout->looked_for, key));
  }
  throw InputError(
      fmt::format("--layout: got '{}', expected one of {}", key, join(each(all, key_of))));
}

}  // namespace

const Layout& layout_of(const std::string& folder, const std::string& key) {
  check_folder(folder);
  std::vector<const Layout*> all, found;
  for (const Layout& layout : kLayouts) {
    all.push_back(&layout);
    if (layout.holds(folder)) found.push_back(&layout);
  }
  if (!key.empty()) return chosen(folder, key, all);
  if (found.size() == 1) return *found[0];
  if (found.empty()) {
    if (holds_colmap_aside(folder)) return kColmap;
    throw InputError(fmt::format("{}: holds no data set, expected one of: {}", folder,
                                 join(each(all, looked_for_by))));
  }
  throw InputError(fmt::format("{}: holds {}, expected one of them, or --layout {}", folder,
                               join(each(found, looked_for_by), " and "),
                               join(each(found, key_of), " or ")));
}

}  // namespace sgs
