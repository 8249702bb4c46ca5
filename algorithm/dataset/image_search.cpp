#include "algorithm/dataset/image_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/image/image_io.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 6> kExtensions = {".png",  ".jpg", ".jpeg",
                                                    ".webp", ".tif", ".tiff"};

bool has_extension(const fs::path& path) {
  return std::find(kExtensions.begin(), kExtensions.end(), extension_of(path)) != kExtensions.end();
}

bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown) && !fs::is_directory(path, unknown);
}

bool is_folder(const fs::path& path) {
  std::error_code unknown;
  return fs::is_directory(path, unknown);
}

void add_once(std::vector<std::string>& paths, const fs::path& path) {
  std::string text = path.lexically_normal().string();
  if (std::find(paths.begin(), paths.end(), text) == paths.end()) paths.push_back(std::move(text));
}

std::vector<std::string> files_of(const std::vector<std::string>& folders,
                                  const std::string& name) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    const fs::path path = fs::path(folder) / name;  // an absolute name is in every folder
    if (is_there(path)) add_once(found, path);
  }
  return found;
}

std::vector<std::string> with_extension(const std::vector<std::string>& folders,
                                        const std::string& name) {
  std::vector<std::string> found;
  for (std::string extension : kExtensions) {
    for (const bool capitals : {false, true}) {
      if (capitals) {
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      }
      for (const std::string& path : files_of(folders, name + extension)) add_once(found, path);
    }
  }
  return found;
}

// Files whose name differs in the case of the extension alone, or that add one in any case.
std::vector<std::string> with_extension_in_any_case(const std::vector<std::string>& folders,
                                                    const std::string& name) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    const fs::path wanted = fs::path(folder) / name;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(wanted.parent_path(), failed)) {
      const fs::path& path = entry.path();
      const bool other_case =
          path.stem() == wanted.stem() && extension_of(path) == extension_of(wanted);
      const bool added = path.stem() == wanted.filename() && has_extension(path);
      if ((other_case || added) && is_there(path)) add_once(found, path);
    }
  }
  return found;
}

std::vector<std::string> found_in(const std::vector<std::string>& folders,
                                  const std::string& name) {
  for (const auto& search : {files_of, with_extension, with_extension_in_any_case}) {
    std::vector<std::string> found = search(folders, name);
    if (!found.empty()) return found;
  }
  return {};
}

// `path` with another first folder, where that is `folder`.
std::optional<std::string> in_other_folder(const std::string& path, const std::string& folder,
                                           const std::string& other) {
  const fs::path normal = fs::path(path).lexically_normal();
  if (normal.empty() || *normal.begin() != folder) return {};
  fs::path out = other;
  for (auto part = std::next(normal.begin()); part != normal.end(); ++part) out /= *part;
  return out.string();
}

}  // namespace

std::string slashed(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

std::string view_name(const std::string& name) {
  fs::path path = fs::path(name).lexically_normal();
  if (has_extension(path)) path.replace_extension();
  return path.string();
}

std::optional<FoundImage> ImageSearch::found(const StatedView& view,
                                             const std::vector<std::string>& folders,
                                             const std::string& name) const {
  for (const std::string& spelled : {name, slashed(name)}) {
    const std::vector<std::string> paths = found_in(below_root(folders), spelled);
    if (paths.size() > 1) {
      throw InputError(fmt::format("{}: image '{}': got {}, expected one of them", view.where, name,
                                   join(paths, " and ")));
    }
    if (!paths.empty()) return FoundImage{spelled, paths[0], read_photograph_header(paths[0])};
  }
  return {};
}

FoundImage ImageSearch::found_or_refused(const StatedView& view,
                                         const std::vector<std::string>& folders,
                                         const std::string& name) const {
  if (auto there = found(view, folders, name)) return *std::move(there);
  throw InputError(fmt::format(
      "{}: no image '{}' in {}, expected it there, or with .png, .jpg, .webp or .tif behind",
      view.where, name, join(below_root(folders), " or ")));
}

std::vector<std::string> ImageSearch::below_root(const std::vector<std::string>& folders) const {
  std::vector<std::string> places;
  for (const std::string& folder : folders) {
    places.push_back(folder.empty() ? root_ : (fs::path(root_) / folder).string());
  }
  return places;
}

std::string ImageSearch::only_smaller_images(const std::string& where) const {
  if (is_folder(fs::path(root_) / "images")) return {};
  std::vector<std::string> there;
  for (const char* name : {"images_2", "images_4", "images_8"}) {
    if (is_folder(fs::path(root_) / name)) there.emplace_back(name);
  }
  if (there.size() > 1) {
    throw InputError(
        fmt::format("{}: no folder images in {}, but {}, expected --images to say which", where,
                    root_, join(there, " and ")));
  }
  return there.empty() ? "" : there[0];
}

FoundImage ImageSearch::image(const StatedView& view) const {
  if (images_.empty()) {
    if (auto there = found(view, view.folders, view.image)) return *std::move(there);
  }
  const std::string other = images_.empty() ? only_smaller_images(view.where) : images_;
  std::vector<std::string> folders = view.folders;
  std::string name = view.image;
  bool moved = false;
  const auto move_into_other = [&](std::string& path) {
    auto to = in_other_folder(path, "images", other);
    if (!to) return;
    path = *std::move(to);
    moved = true;
  };
  if (!other.empty()) {
    for (std::string& folder : folders) move_into_other(folder);
    std::string with_slashes = slashed(name);
    move_into_other(with_slashes);
    if (moved) name = with_slashes;
  }
  if (!images_.empty() && !moved) {
    throw InputError(
        fmt::format("{}: --images {}: got the image '{}', expected one in a folder images",
                    view.where, images_, name));
  }
  FoundImage there = found_or_refused(view, folders, name);
  if (moved) {
    instead_ = other;
    there.name = slashed(view.image);  // whatever folder it is taken from, it is the same view
  }
  return there;
}

FoundImage ImageSearch::mask(const StatedView& view) const {
  const std::string images = "images";
  if (instead_.rfind(images, 0) == 0) {
    const std::string masks = "masks" + instead_.substr(images.size());
    const auto smaller = in_other_folder(slashed(view.mask), "masks", masks);
    if (smaller && is_folder(fs::path(root_) / masks))
      return found_or_refused(view, {""}, *smaller);
  }
  return found_or_refused(view, {""}, view.mask);
}

}  // namespace sgs
