// The table of forms for load_scene.h: each is recognised by how its files begin, or by their name
// where they begin like nothing.
#include "algorithm/scene_files/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_kinds.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene_files/compressed_ply.h"
#include "algorithm/scene_files/gltf_file.h"
#include "algorithm/scene_files/ksplat_file.h"
#include "algorithm/scene_files/sog_files.h"
#include "algorithm/scene_files/splat_file.h"
#include "algorithm/scene_files/spz_file.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

// What is at a path, as far as it tells the form.
struct Place {
  std::string path;
  std::string extension;  // in small letters
  std::string start;      // the first bytes; none of a folder or of what is not there

  bool begins_with(std::string_view bytes) const {
    return start.compare(0, bytes.size(), bytes) == 0;
  }
};

Place place_of(const std::string& path) {
  constexpr std::uint64_t kStartBytes = 4096;
  Place place{path, fs::path(path).extension().string(), {}};
  std::transform(place.extension.begin(), place.extension.end(), place.extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::error_code unknown;
  if (fs::is_regular_file(path, unknown)) place.start = InputFile(path).text_from(0, kStartBytes);
  return place;
}

bool is_ply(const Place& place) {
  return place.begins_with("ply\n") || place.begins_with("ply\r") || place.extension == ".ply";
}

bool is_compressed(const Place& place) {
  return is_ply(place) && place.start.find("\nelement chunk ") != std::string::npos &&
         is_compressed_ply(read_ply_header(InputFile(place.path)));
}

struct Form {
  const char* name;
  const char* endings;
  bool (*recognises)(const Place& place);
  SceneContents (*read)(const std::string& path, const SceneReadOptions& options);
  bool has_levels;
};

constexpr Form kForms[] = {
    {"compressed PLY", ".compressed.ply", is_compressed, read_compressed_ply, false},
    {"PLY", ".ply", is_ply, read_ply, false},
    {"SPZ", ".spz",
     [](const Place& place) {
       return place.begins_with("NGSP") || place.begins_with("\x1f\x8b") ||
              place.extension == ".spz";
     },
     read_spz, false},
    {"glTF", ".glb, .gltf",
     [](const Place& place) {
       return place.begins_with("glTF") || place.extension == ".glb" || place.extension == ".gltf";
     },
     read_gltf, false},
    {"streamed SOG", "lod-meta.json",
     [](const Place& place) { return is_streamed_sog(place.path); }, read_streamed_sog, true},
    {"SOG", ".sog, meta.json",
     [](const Place& place) {
       return place.begins_with("PK\x03\x04") || place.extension == ".sog" ||
              is_sog_folder(place.path);
     },
     read_sog, false},
    {"ksplat", ".ksplat", [](const Place& place) { return place.extension == ".ksplat"; },
     read_ksplat, false},
    {"splat", ".splat", [](const Place& place) { return place.extension == ".splat"; }, read_splat,
     false},
};

const Form* form_of(const Place& place) {
  const auto* const found = std::find_if(std::begin(kForms), std::end(kForms),
                                         [&](const Form& form) { return form.recognises(place); });
  return found == std::end(kForms) ? nullptr : found;
}

// What people have beside the forms above.
const char* remedy_for(const Place& place) {
  if (place.extension == ".lcc" || place.extension == ".lcc2") {
    return "; splat-transform makes a .ply of the form of XGrids";
  }
  if (place.extension == ".pt" || place.extension == ".pth" || place.extension == ".ckpt") {
    return "; a checkpoint's own trainer exports a .ply";
  }
  return "";
}

}  // namespace

std::string scene_endings() {
  std::vector<std::string> endings;
  for (const Form& form : kForms) endings.emplace_back(form.endings);
  return join(endings);
}

std::string scene_name(const std::string& path) {
  const fs::path file(path);
  const std::string name = file.filename().string();
  if (name == kSogMeta || name == kStreamedSogMeta) {
    return fs::absolute(file).lexically_normal().parent_path().filename().string();
  }
  return file.has_filename() ? file.stem().string() : file.parent_path().filename().string();
}

bool is_scene_file(const std::string& path) { return form_of(place_of(path)) != nullptr; }

Scene load_scene(const std::string& path, const SceneReadOptions& options) {
  const Place place = place_of(path);
  const Form* const form = form_of(place);
  if (form == nullptr) {
    throw InputError(fmt::format("{}: got the extension \"{}\", expected a scene ({}){}", path,
                                 fs::path(path).extension().string(), scene_endings(),
                                 remedy_for(place)));
  }
  if (options.level && !form->has_levels) {
    throw InputError(
        fmt::format("{}: got level {} of a {} file, which has no levels, expected it "
                    "with {}",
                    path, *options.level, form->name, kStreamedSogMeta));
  }
  SceneContents read = form->read(path, options);
  return {scene_name(path), std::move(read.cloud), {}, read.dropped_invalid,
          form->name,       std::move(read.notes)};
}

std::vector<std::string> files_of_scene(const std::string& path) {
  const fs::path place(path);
  std::error_code unknown;
  const std::string name = place.filename().string();
  const bool is_meta = name == kSogMeta || name == kStreamedSogMeta || place.extension() == ".gltf";
  const fs::path folder = is_meta ? fs::absolute(place).parent_path() : place;
  if (!fs::is_directory(folder, unknown)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder, unknown)) {
    if (entry.is_regular_file(unknown)) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace sgs
