// The table of forms for load_scene.h: each is recognised by how its files begin, or by their name
// where they begin like nothing.
#include "algorithm/scene_files/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene_files/assembled_scene.h"
#include "algorithm/scene_files/scene_forms.h"

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
  Place place{path, extension_of(path), {}};
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
  bool has_levels = false;
  // Those that it opens, where that may be several.
  std::vector<std::string> (*files)(const std::string& path,
                                    const SceneReadOptions& options) = nullptr;
};

constexpr Form kForms[] = {
    {"compressed PLY", ".compressed.ply", is_compressed, read_compressed_ply},
    {"PLY", ".ply", is_ply, read_ply},
    {"SPZ", ".spz",
     [](const Place& place) {
       return place.begins_with("NGSP") || place.begins_with("\x1f\x8b") ||
              place.extension == ".spz";
     },
     read_spz},
    {"glTF", ".glb, .gltf",
     [](const Place& place) {
       return place.begins_with("glTF") || place.extension == ".glb" || place.extension == ".gltf";
     },
     read_gltf, false, files_of_gltf},
    {"streamed SOG", "lod-meta.json",
     [](const Place& place) { return is_streamed_sog(place.path); }, read_streamed_sog, true,
     files_of_streamed_sog},
    {"SOG", ".sog, meta.json",
     [](const Place& place) {
       return place.begins_with("PK\x03\x04") || place.extension == ".sog" ||
              is_sog_folder(place.path);
     },
     read_sog, false, files_of_sog},
    {"ksplat", ".ksplat", [](const Place& place) { return place.extension == ".ksplat"; },
     read_ksplat},
    {"splat", ".splat", [](const Place& place) { return place.extension == ".splat"; }, read_splat},
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
  const std::string axes = options.axes.empty() ? read.axes : options.axes;
  const bool turns = !axes.empty() && axes != "rdf";
  if (turns) {
    const std::optional<Placement> placement = Placement::from_axes(axes);
    if (!placement) {
      throw InputError(
          fmt::format("{}: got the axes {}, expected r or l, d or u and f or b in any "
                      "order that does not mirror, as rub",
                      path, axes));
    }
    read = placed(path, std::move(read), *placement, options);
    read.notes.push_back(fmt::format("turned from axes {} to right, down, forward", axes));
  }
  Scene scene{scene_name(path), std::move(read.cloud), {}, read.dropped_invalid, form->name};
  if (turns) scene.axes = axes;
  scene.notes = std::move(read.notes);
  return scene;
}

std::vector<std::string> files_of_scene(const std::string& path, const SceneReadOptions& options) {
  const Form* const form = form_of(place_of(path));
  if (form == nullptr || form->files == nullptr) return {path};
  std::vector<std::string> files = form->files(path, options);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace sgs
