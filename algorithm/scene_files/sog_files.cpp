// meta.json, pictures and numbers of sog_files.h.
#include "algorithm/scene_files/sog_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/files/input_json.h"
#include "algorithm/scene/ply_kinds.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/joined_scenes.h"
#include "algorithm/scene_files/scene_parts.h"
#include "algorithm/scene_files/webp_texture.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Codebook = std::array<float, 256>;

constexpr std::uint64_t kPaletteColumns = 64;  // entries a row of the centroids' picture

Codebook codebook_of(const JsonPlace& fields, float missing) {
  const std::vector<double> values = fields.at("codebook").numbers();
  Codebook book;
  book.fill(missing);
  if (values.size() > book.size()) fields.at("codebook").refuse("at most 256 numbers");
  std::transform(values.begin(), values.end(), book.begin(),
                 [](double value) { return static_cast<float>(value); });
  return book;
}

std::string file_name(const JsonPlace& fields, std::size_t index) {
  const std::vector<std::string> names = fields.at("files").texts();
  if (names.size() <= index) fields.at("files").refuse(fmt::format("{} names or more", index + 1));
  return names[index];
}

// Coordinates: a share of 65535 between two ends of sign(x) ln(|x| + 1).
struct Centres {
  RgbaTexture low, high;
  std::array<double, 3> least, span;

  Centres(const SceneParts& parts, const JsonPlace& fields, std::uint64_t count)
      : low(read_webp(parts, file_name(fields, 0), count)),
        high(read_webp(parts, file_name(fields, 1), count)) {
    const std::vector<double> mins = fields.at("mins").numbers(3),
                              maxs = fields.at("maxs").numbers(3);
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = mins[i];
      span[i] = maxs[i] == mins[i] ? 1 : maxs[i] - mins[i];
    }
  }
  float at(std::uint64_t index, std::size_t axis) const {
    const int steps = low.pixel(index)[axis] | high.pixel(index)[axis] << 8;
    const double value = least[axis] + span[axis] * (steps / 65535.0);
    const double magnitude = std::exp(std::abs(value)) - 1;
    return static_cast<float>(value < 0 ? -magnitude : magnitude);
  }
};

void decode_rotation(const std::uint8_t* pixel, float* rotation) {
  constexpr int kFirstTag = 252;  // of a largest component w; then x, y, z
  const int largest = pixel[3] - kFirstTag;
  if (largest < 0) {
    std::copy_n(std::array<float, 4>{1, 0, 0, 0}.begin(), 4, rotation);
    return;
  }
  double squared = 0;
  for (int k = 0, from = 0; k < 4; ++k) {
    if (k == largest) continue;
    const double part = (pixel[from++] / 255.0 * 2 - 1) / std::sqrt(2.0);
    rotation[k] = static_cast<float>(part);
    squared += part * part;
  }
  rotation[largest] = static_cast<float>(std::sqrt(std::max(0.0, 1 - squared)));
}

// SH coefficients: a label for each Gaussian, a palette entry for each label, an index of the
// codebook for each number of an entry.
struct Palette {
  int degree = 0;
  std::uint64_t count = 0;
  RgbaTexture entries, labels;
  Codebook codebook;

  Palette(const SceneParts& parts, const JsonPlace& fields, std::uint64_t gaussians) {
    const std::uint64_t bands = fields.at("bands").whole();
    if (bands < 1 || bands > 3) fields.at("bands").refuse("1 to 3");
    degree = static_cast<int>(bands);
    codebook = codebook_of(fields, 0);
    count = fields.at("count").whole();
    const auto coeffs = static_cast<std::uint64_t>(rest_coeff_count(degree));
    const std::uint64_t rows = (count + kPaletteColumns - 1) / kPaletteColumns;
    entries = read_webp(parts, file_name(fields, 0), kPaletteColumns * coeffs * rows);
    if (entries.width != kPaletteColumns * coeffs) {
      throw InputError(fmt::format("{}: {}: got {} px a row, expected {} for {} bands",
                                   fields.name(), file_name(fields, 0), entries.width,
                                   kPaletteColumns * coeffs, bands));
    }
    labels = read_webp(parts, file_name(fields, 1), gaussians);
  }
  void fill(std::uint64_t index, float* slots) const {
    const int coeffs = rest_coeff_count(degree);
    const std::uint8_t* pixel = labels.pixel(index);
    const std::uint64_t label = pixel[0] | pixel[1] << 8;
    for (int k = 0; k < coeffs; ++k) {
      const std::uint8_t* entry =
          label < count
              ? entries.pixel(label / kPaletteColumns * entries.width +
                              label % kPaletteColumns * static_cast<std::uint64_t>(coeffs) +
                              static_cast<std::uint64_t>(k))
              : nullptr;
      for (int channel = 0; channel < 3; ++channel) {
        slots[rest_slot(degree, channel, k)] = entry != nullptr ? codebook[entry[channel]] : 0;
      }
    }
  }
};

void check_version(const JsonPlace& meta) {
  const char* expected =
      meta.has("means") ? "2: splat-transform makes it of a SOG of version 1" : "2";
  const JsonPlace version = meta.at("version", expected);
  if (version.whole() != 2) version.refuse("2");
}

SceneContents read_parts(const SceneParts& parts, const std::string& meta_name,
                         const SceneReadOptions& options) {
  const std::string origin = parts.origin(meta_name);
  const Json json = parse_json(parts.bytes(meta_name), origin);
  const JsonPlace meta(origin, json);
  check_version(meta);
  const std::uint64_t count = meta.at("count").whole();
  const std::string model = meta.has("model") ? meta.at("model").text() : "default";
  if (model == "2dgs") meta.at("model").refuse("3D Gaussians");
  const Centres centres(parts, meta.at("means"), count);
  const RgbaTexture rotations = read_webp(parts, file_name(meta.at("quats"), 0), count);
  const RgbaTexture scales = read_webp(parts, file_name(meta.at("scales"), 0), count);
  const RgbaTexture colours = read_webp(parts, file_name(meta.at("sh0"), 0), count);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const Codebook scale_book = codebook_of(meta.at("scales"), kNone);
  const Codebook colour_book = codebook_of(meta.at("sh0"), kNone);
  std::optional<Palette> palette;
  if (meta.has("shN")) palette.emplace(parts, meta.at("shN"), count);

  SceneContents contents =
      decoded_scene(origin, count, palette ? palette->degree : 0, options,
                    [&](std::uint64_t index, float* slots) {
                      for (std::size_t i = 0; i < 3; ++i) {
                        slots[kMeanSlot + i] = centres.at(index, i);
                        slots[kScaleSlot + i] = scale_book[scales.pixel(index)[i]];
                        slots[kDcSlot + i] = colour_book[colours.pixel(index)[i]];
                      }
                      slots[kOpacitySlot] = logit_of_byte(colours.pixel(index)[3]);
                      decode_rotation(rotations.pixel(index), slots + kRotationSlot);
                      if (palette) palette->fill(index, slots);
                    });
  if (model == "antialiased") contents.notes.emplace_back(kAntialiasedNote);
  return contents;
}

// `name`, in the folder `path` or as it is itself.
std::string named_file(const std::string& path, const char* name) {
  std::error_code unknown;
  const fs::path place(path);
  if (place.filename() == name) return path;
  const fs::path within = place / name;
  return fs::is_directory(place, unknown) && fs::exists(within, unknown) ? within.string() : "";
}

// Of each file of a level, by its number, the Gaussians that the tree says it has.
using LevelFiles = std::map<std::uint64_t, std::uint64_t>;

void add_files(const JsonPlace& node, const std::string& level, std::uint64_t file_count,
               LevelFiles& files) {
  if (node.has("lods")) {
    const JsonPlace lods = node.at("lods");
    if (lods.has(level)) {
      const JsonPlace part = lods.at(level);
      const std::uint64_t file = part.at("file").whole();
      if (file >= file_count) part.at("file").refuse("one of filenames");
      part.at("offset").whole();
      files[file] += part.at("count").whole();
    }
  }
  if (!node.has("children")) return;
  for (const JsonPlace& child : node.at("children").elements()) {
    add_files(child, level, file_count, files);
  }
}

}  // namespace

bool is_sog_folder(const std::string& path) {
  const std::string meta = named_file(path, kSogMeta);
  if (meta.empty() || meta == path) return !meta.empty();
  // Folders of photographs may have a meta.json, too.
  constexpr std::uint64_t kMostBytes = 1 << 20;
  std::error_code unknown;
  return fs::is_regular_file(meta, unknown) &&
         InputFile(meta).text_from(0, kMostBytes).find("\"means\"") != std::string::npos;
}
bool is_streamed_sog(const std::string& path) {
  return !named_file(path, kStreamedSogMeta).empty();
}

SceneContents read_sog(const std::string& path, const SceneReadOptions& options) {
  const std::string meta = named_file(path, kSogMeta);
  return read_parts(meta.empty() ? *open_zip(path) : *open_folder_of(meta), kSogMeta, options);
}

SceneContents read_streamed_sog(const std::string& path, const SceneReadOptions& options) {
  const std::string meta_path = named_file(path, kStreamedSogMeta);
  const std::unique_ptr<SceneParts> parts = open_folder_of(meta_path);
  const Json json = read_json(meta_path);
  const JsonPlace meta(meta_path, json);
  if (meta.whole_or("version", 1) != 1) meta.at("version").refuse("1");
  const std::uint64_t levels = meta.at("lodLevels").whole();
  const std::uint32_t level = options.level.value_or(0);
  if (level >= levels) {
    throw InputError(fmt::format("{}: got level {}, expected one of its {} levels, from 0",
                                 meta_path, level, levels));
  }
  const std::vector<std::string> names = meta.at("filenames").texts();
  LevelFiles files;
  add_files(meta.at("tree"), std::to_string(level), names.size(), files);

  SceneContents all;
  const SceneReadOptions each{options.drop_invalid};
  for (const auto& [number, count] : files) {
    const std::string& name = names[number];
    const std::string origin = parts->origin(name);
    parts->check_name(name);
    SceneContents part = read_sog((fs::path(meta_path).parent_path() / name).string(), each);
    if (part.cloud.size() + part.dropped_invalid != count) {
      throw InputError(fmt::format("{}: got {} Gaussians, expected {} as {} says", origin,
                                   part.cloud.size() + part.dropped_invalid, count, meta_path));
    }
    append_scene(origin, std::move(part), all);
  }
  all.notes.push_back(fmt::format("level {} of 0 to {}, 0 the finest", level, levels - 1));
  if (meta.has("environment")) {
    all.notes.push_back(fmt::format("its environment {} is of no level and is not drawn",
                                    shown(meta.at("environment").json())));
  }
  return all;
}

}  // namespace sgs
