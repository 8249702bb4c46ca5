// The folder that `simulate` writes: which files of a view or a camera path it holds, and which of
// them are there from an earlier run.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "testbench/streaminggs/report/error_maps.h"

namespace sgs {

constexpr const char* kGroupTableFile = "groups.csv";
constexpr const char* kViewFiles[] = {"frame.exr",     "frame.png",   "reference.exr",
                                      "reference.png", "report.json", kGroupTableFile};

// Beside these where there are two eyes.
constexpr const char* kRightEyeFiles[] = {"right_frame.exr", "right_frame.png",
                                          "right_reference.exr"};

class ResultFolder {
 public:
  using Path = std::filesystem::path;

  explicit ResultFolder(Path path) : path_(std::move(path)) {}

  Path report() const { return path_ / "report.json"; }
  Path view(int number) const { return path_ / fmt::format("view_{}", number); }

  // Files of a camera path, beside the report. eye: 1 for the right one of two.
  Path frame(std::size_t number, std::uint32_t eye = 0) const {
    return frames() / fmt::format("{:04}{}.png", number, eye > 0 ? "_right" : "");
  }
  Path path_table() const { return path_ / "path.csv"; }
  Path contact_sheet() const { return path_ / "contact_sheet.png"; }

  // Every file that a view may have.
  static std::vector<Path> files_of(const Path& view) {
    std::vector<Path> files;
    for (const char* name : kViewFiles) files.push_back(view / name);
    for (const char* name : kRightEyeFiles) files.push_back(view / name);
    for (const char* name : kErrorMapFiles) files.push_back(view / name);
    return files;
  }

  // Those of any view or path that are there, in folders that are no links.
  std::vector<Path> present() const {
    std::vector<Path> files;
    const auto add = [&](const Path& file) {
      std::error_code none;
      if (std::filesystem::is_regular_file(file, none)) files.push_back(file);
    };
    for (const Path& folder : view_folders()) {
      for (const Path& file : files_of(folder)) add(file);
    }
    for (const Path& file : frame_files()) add(file);
    for (const Path& file : {path_table(), contact_sheet()}) add(file);
    return files;
  }

  // Removes the report and what is there of any view or path but `kept`: they tell of another run.
  // Files that `simulate` did not write stay, and so does a folder that holds one.
  void keep_only(const std::vector<Path>& kept) const {
    std::error_code ignored;
    std::filesystem::remove(report(), ignored);
    for (const Path& file : present()) {
      if (std::find(kept.begin(), kept.end(), file) != kept.end()) continue;
      std::filesystem::remove(file, ignored);
      if (file.parent_path() == path_) continue;
      std::filesystem::remove(file.parent_path(), ignored);  // fails as long as it holds something
    }
  }

 private:
  Path frames() const { return path_ / "frames"; }

  // Named as frame() does.
  std::vector<Path> frame_files() const {
    std::vector<Path> files;
    std::error_code missing;
    if (std::filesystem::is_symlink(frames(), missing)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(frames(), missing)) {
      std::size_t number = 0;
      const std::string name = entry.path().filename().string();
      if (std::sscanf(name.c_str(), "%9zu", &number) == 1 &&
          (entry.path() == frame(number) || entry.path() == frame(number, 1))) {
        files.push_back(entry.path());
      }
    }
    return files;
  }

  // Named as view() does.
  std::vector<Path> view_folders() const {
    std::vector<Path> folders;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(path_, missing)) {
      const std::string name = entry.path().filename().string();
      int number = 0;
      const bool ours =
          std::sscanf(name.c_str(), "view_%9d", &number) == 1 && entry.path() == view(number);
      if (ours && entry.symlink_status().type() == std::filesystem::file_type::directory) {
        folders.push_back(entry.path());
      }
    }
    return folders;
  }

  Path path_;
};

}  // namespace sgs
