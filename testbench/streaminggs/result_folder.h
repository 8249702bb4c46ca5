// The folder that `simulate` writes: which files of a view it holds, and which of them are there
// from an earlier run.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "testbench/streaminggs/error_maps.h"

namespace sgs {

constexpr const char* kGroupTableFile = "groups.csv";
constexpr const char* kViewFiles[] = {"frame.exr",     "frame.png",   "reference.exr",
                                      "reference.png", "report.json", kGroupTableFile};

class ResultFolder {
 public:
  using Path = std::filesystem::path;

  explicit ResultFolder(Path path) : path_(std::move(path)) {}

  Path report() const { return path_ / "report.json"; }
  Path view(int number) const { return path_ / fmt::format("view_{}", number); }

  // Every file that a view may have.
  static std::vector<Path> files_of(const Path& view) {
    std::vector<Path> files;
    for (const char* name : kViewFiles) files.push_back(view / name);
    for (const char* name : kErrorMapFiles) files.push_back(view / name);
    return files;
  }

  // Those of any view that are there, in folders that are no links.
  std::vector<Path> present() const {
    std::vector<Path> files;
    for (const Path& folder : view_folders()) {
      for (const Path& file : files_of(folder)) {
        std::error_code none;
        if (std::filesystem::is_regular_file(file, none)) files.push_back(file);
      }
    }
    return files;
  }

  // Removes the report and every view but `number`: they tell of another run. What is not of
  // `simulate` stays, and so does a folder that holds it.
  void keep_only(int number) const {
    std::error_code ignored;
    std::filesystem::remove(report(), ignored);
    for (const Path& file : present()) {
      if (file.parent_path() == view(number)) continue;
      std::filesystem::remove(file, ignored);
      std::filesystem::remove(file.parent_path(), ignored);  // fails as long as it holds something
    }
  }

 private:
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
