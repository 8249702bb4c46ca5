// Neural Sparse Voxel Fields' layout (layout.h).
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "algorithm/dataset/layout.h"
#include "algorithm/dataset/text_fields.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostFileBytes = 1 << 16;

std::vector<double> numbers_in(const std::string& path) {
  const InputFile file(path);
  if (file.size_bytes() > kMostFileBytes) {
    throw InputError(fmt::format("{}: got {} bytes, expected a matrix in text of at most {}", path,
                                 file.size_bytes(), kMostFileBytes));
  }
  const std::string text = file.text_from(0, kMostFileBytes);
  std::vector<double> numbers;
  for (TextFields fields(text, path); !fields.at_end();) numbers.push_back(fields.number("number"));
  return numbers;
}

// Width and height 0 where only the images state them.
Intrinsics read_intrinsics(const std::string& path) {
  const std::vector<double> n = numbers_in(path);
  Intrinsics intrinsics;
  const auto principal_point = [&](double x, double y) {
    intrinsics.centre_x = x;
    intrinsics.centre_y = y;
  };
  if (n.size() == 9 || n.size() == 16) {  // a matrix of 3x3 or 4x4
    const std::size_t row = n.size() == 9 ? 3 : 4;
    intrinsics.focal_x = n[0];
    intrinsics.focal_y = n[row + 1];
    principal_point(n[2], n[row + 2]);
    if (n[1] != 0 || n[row] != 0) {
      throw InputError(fmt::format("{}: got a skew of {} and {}, expected 0", path, n[1], n[row]));
    }
  } else if (n.size() == 11) {  // f c_x c_y 0; origin; near; scale; height width
    intrinsics.focal_x = intrinsics.focal_y = n[0];
    principal_point(n[1], n[2]);
    if (!(n[9] >= 1 && n[9] <= INT32_MAX && n[10] >= 1 && n[10] <= INT32_MAX)) {
      throw InputError(fmt::format("{}: got a height of {} and a width of {}, expected px from 1",
                                   path, n[9], n[10]));
    }
    intrinsics.height = static_cast<int>(n[9]);
    intrinsics.width = static_cast<int>(n[10]);
  } else {
    throw InputError(fmt::format(
        "{}: got {} numbers, expected 9 or 16 (a matrix) or 11 (f c_x c_y 0, and what follows)",
        path, n.size()));
  }
  return intrinsics;
}

Pose read_pose(const std::string& path) {
  const std::vector<double> numbers = numbers_in(path);
  if (numbers.size() != 16) {
    throw InputError(fmt::format("{}: got {} numbers, expected 4x4", path, numbers.size()));
  }
  glm::dmat4 world_from_camera(1.0);
  for (int i = 0; i < 16; ++i)
    world_from_camera[i % 4][i / 4] = numbers[static_cast<std::size_t>(i)];
  return opencv_pose(world_from_camera, path + ": pose");
}

Extent read_bounds(const std::string& path) {
  const std::vector<double> n = numbers_in(path);
  if (n.size() < 6 || !(n[0] < n[3] && n[1] < n[4] && n[2] < n[5])) {
    throw InputError(fmt::format("{}: got {} numbers, expected the lower corner, then a higher one",
                                 path, n.size()));
  }
  return {glm::vec3(n[0], n[1], n[2]), glm::vec3(n[3], n[4], n[5])};
}

// Names of the poses, without extension, sorted.
std::vector<std::string> names_in(const fs::path& poses) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(poses, failed)) {
    if (entry.path().extension() == ".txt") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// '0', '1' or '2' as the name begins, else 0 for none.
char prefix_of(const std::string& name) {
  const bool has = name.size() > 1 && name[0] >= '0' && name[0] <= '2' && name[1] == '_';
  return has ? name[0] : '\0';
}

// Which prefix is which split. 0_ trains; 2_ tests and 1_ is for validation, or, where there is no
// 2_, 1_ tests. Nothing where all are alike: without a prefix, or with 0_ alone.
std::map<char, Split> splits_of(const std::vector<std::string>& names, const std::string& folder) {
  std::set<char> prefixes;
  for (const std::string& name : names) prefixes.insert(prefix_of(name));
  if (prefixes == std::set<char>{'0'}) return {};
  if (prefixes.count('\0') == 0) {
    return {{'0', Split::kTrain}, {prefixes.count('2') > 0 ? '2' : '1', Split::kTest}};
  }
  if (prefixes.size() > 1) {
    throw InputError(fmt::format(
        "{}/pose: got names with and without 0_, 1_ or 2_ before them, expected all of one kind",
        folder));
  }
  return {};
}

}  // namespace

bool holds_nsvf(const std::string& folder) {
  std::error_code unknown;
  return fs::exists(fs::path(folder) / "intrinsics.txt", unknown) &&
         fs::is_directory(fs::path(folder) / "pose", unknown) &&
         fs::is_directory(fs::path(folder) / "rgb", unknown);
}

StatedDataset read_nsvf(const std::string& folder) {
  const fs::path root(folder);
  const std::string intrinsics_path = (root / "intrinsics.txt").string();
  const Intrinsics stated = read_intrinsics(intrinsics_path);
  const std::vector<std::string> names = names_in(root / "pose");
  const std::map<char, Split> splits = splits_of(names, folder);
  StatedDataset dataset;
  dataset.files = {intrinsics_path};
  dataset.split_by = splits.empty() ? SplitBy::kEveryEighth : SplitBy::kDataset;
  for (const std::string& name : names) {
    const std::string pose = (root / "pose" / (name + ".txt")).string();
    dataset.files.push_back(pose);
    const auto split = splits.find(prefix_of(name));
    if (!splits.empty() && split == splits.end()) {
      ++dataset.left_out;
      continue;
    }
    StatedView view;
    view.where = pose;
    view.folders = {"rgb"};
    view.image = name;
    view.intrinsics = stated;
    view.pose = read_pose(pose);
    view.split = splits.empty() ? Split::kTrain : split->second;
    dataset.views.push_back(std::move(view));
  }
  const std::string bounds = (root / "bbox.txt").string();
  std::error_code unknown;
  if (fs::exists(bounds, unknown)) {
    dataset.bounds = read_bounds(bounds);
    dataset.files.push_back(bounds);
  }
  return dataset;
}

}  // namespace sgs
