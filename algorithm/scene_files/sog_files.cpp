// meta.json, pictures and numbers of SOG (scene_forms.h).
#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/files/input_json.h"
#include "algorithm/image/image_formats.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene_files/assembled_scene.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/scene_forms.h"
#include "algorithm/scene_files/stored_bytes.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Codebook = std::array<float, 256>;

constexpr std::uint64_t kPaletteColumns = 64;  // entries a row of the centroids' picture

// What is beyond it is no number, which decoded_scene refuses.
Codebook codebook_of(const JsonPlace& fields) {
  const std::vector<double> values = fields.at("codebook").numbers();
  Codebook book;
  book.fill(std::numeric_limits<float>::quiet_NaN());
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

// A picture whose pixels are numbers, at least `pixels` of them.
RgbaSamples read_texture(const SceneParts& parts, const std::string& name, std::uint64_t pixels) {
  RgbaSamples texture = decode_webp(parts.origin(name), parts.bytes(name));
  if (texture.rgba.size() / 4 < pixels) {
    throw InputError(fmt::format("{}: got {}x{} px, expected at least {} px", parts.origin(name),
                                 texture.width, texture.height, pixels));
  }
  return texture;
}

// Coordinates: a share of 65535 between two ends of sign(x) ln(|x| + 1).
struct Centres {
  RgbaSamples low, high;
  std::array<double, 3> least, span;

  Centres(const SceneParts& parts, const JsonPlace& fields, std::uint64_t count)
      : low(read_texture(parts, file_name(fields, 0), count)),
        high(read_texture(parts, file_name(fields, 1), count)) {
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

// False where the pixel holds none: the Gaussian is not turned.
bool decode_rotation(const std::uint8_t* pixel, float* rotation) {
  constexpr int kFirstTag = 252;  // of a largest component w; then x, y, z
  const int largest = pixel[3] - kFirstTag;
  if (largest < 0) {
    std::copy_n(std::array<float, 4>{1, 0, 0, 0}.begin(), 4, rotation);
    return false;
  }
  const auto next = [&] { return (*pixel++ / 255.0 * 2 - 1) / std::sqrt(2.0); };
  decode_smallest_three({0, 1, 2, 3}, largest, next, rotation);
  return true;
}

// SH coefficients: a label for each Gaussian, a palette entry for each label, an index of the
// codebook for each number of an entry.
struct Palette {
  int degree = 0;
  std::uint64_t count = 0;
  RgbaSamples entries, labels;
  Codebook codebook;

  Palette(const SceneParts& parts, const JsonPlace& fields, std::uint64_t gaussians) {
    const std::uint64_t bands = fields.at("bands").whole();
    if (bands < 1 || bands > 3) fields.at("bands").refuse("1 to 3");
    degree = static_cast<int>(bands);
    codebook = codebook_of(fields);
    count = fields.at("count").whole();
    const auto coeffs = static_cast<std::uint64_t>(rest_coeff_count(degree));
    const std::uint64_t rows = (count + kPaletteColumns - 1) / kPaletteColumns;
    entries = read_texture(parts, file_name(fields, 0), kPaletteColumns * coeffs * rows);
    if (static_cast<std::uint64_t>(entries.width) != kPaletteColumns * coeffs) {
      throw InputError(fmt::format("{}: {}: got {} px a row, expected {} for {} bands",
                                   fields.name(), file_name(fields, 0), entries.width,
                                   kPaletteColumns * coeffs, bands));
    }
    labels = read_texture(parts, file_name(fields, 1), gaussians);
  }
  // False where the label is beyond the palette: all coefficients are 0.
  bool fill(std::uint64_t index, float* slots) const {
    const auto coeffs = static_cast<std::uint64_t>(rest_coeff_count(degree));
    const std::uint8_t* pixel = labels.pixel(index);
    const std::uint64_t label = pixel[0] | pixel[1] << 8;
    if (label >= count) {
      std::fill_n(slots + kRestSlot, 3 * coeffs, 0.0F);
      return false;
    }
    const std::uint64_t row = label / kPaletteColumns, column = label % kPaletteColumns;
    for (std::uint64_t k = 0; k < coeffs; ++k) {
      const std::uint8_t* entry = entries.pixel((row * kPaletteColumns + column) * coeffs + k);
      for (int channel = 0; channel < 3; ++channel) {
        slots[rest_slot(degree, channel, static_cast<int>(k))] = codebook[entry[channel]];
      }
    }
    return true;
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
  const RgbaSamples rotations = read_texture(parts, file_name(meta.at("quats"), 0), count);
  const RgbaSamples scales = read_texture(parts, file_name(meta.at("scales"), 0), count);
  const RgbaSamples colours = read_texture(parts, file_name(meta.at("sh0"), 0), count);
  const Codebook scale_book = codebook_of(meta.at("scales"));
  const Codebook colour_book = codebook_of(meta.at("sh0"));
  std::optional<Palette> palette;
  if (meta.has("shN")) palette.emplace(parts, meta.at("shN"), count);

  std::atomic<std::uint64_t> unturned{0}, unlabelled{0};
  SceneContents contents =
      decoded_scene(origin, count, palette ? palette->degree : 0, options,
                    [&](std::uint64_t index, float* slots) {
                      for (std::size_t i = 0; i < 3; ++i) {
                        slots[kMeanSlot + i] = centres.at(index, i);
                        slots[kScaleSlot + i] = scale_book[scales.pixel(index)[i]];
                        slots[kDcSlot + i] = colour_book[colours.pixel(index)[i]];
                      }
                      slots[kOpacitySlot] = logit_of_byte(colours.pixel(index)[3]);
                      if (!decode_rotation(rotations.pixel(index), slots + kRotationSlot)) {
                        ++unturned;
                      }
                      if (palette && !palette->fill(index, slots)) ++unlabelled;
                    });
  if (unturned > 0) {
    contents.notes.push_back(
        fmt::format("{} Gaussians have no rotation and are not turned", unturned.load()));
  }
  if (unlabelled > 0) {
    contents.notes.push_back(
        fmt::format("{} Gaussians have labels beyond the palette of {} and look alike from all "
                    "sides",
                    unlabelled.load(), palette->count));
  }
  const bool antialiased = meta.has("antialias") && meta.at("antialias").flag();
  if (antialiased || model == "antialiased") contents.notes.emplace_back(kAntialiasedNote);
  return contents;
}

// Of each member of meta.json the pictures that read_parts() reads.
constexpr std::pair<const char*, std::size_t> kPictures[] = {
    {"means", 2}, {"quats", 1}, {"scales", 1}, {"sh0", 1}, {"shN", 2}};

// `name`, in the folder `path` or as it is itself.
std::string named_file(const std::string& path, const char* name) {
  std::error_code unknown;
  const fs::path place(path);
  if (place.filename() == name) return path;
  const fs::path within = place / name;
  return fs::is_directory(place, unknown) && fs::exists(within, unknown) ? within.string() : "";
}

// What lod-meta.json says of the level that `options` name.
struct Level {
  std::string meta_path;
  std::vector<std::pair<std::string, std::uint64_t>> parts;  // places and how many Gaussians
  std::vector<std::string> notes;

  Level(const std::string& path, const SceneReadOptions& options)
      : meta_path(named_file(path, kStreamedSogMeta)) {
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
    std::map<std::uint64_t, std::uint64_t> counts;  // of Gaussians, by the number of the file
    add_counts(meta.at("tree"), std::to_string(level), names.size(), counts);
    const std::unique_ptr<SceneParts> folder = open_folder_of(meta_path);
    for (const auto& [number, count] : counts) {
      folder->check_name(names[number]);
      parts.emplace_back((fs::path(meta_path).parent_path() / names[number]).string(), count);
    }
    notes.push_back(fmt::format("level {} of 0 to {}, 0 the finest", level, levels - 1));
    if (meta.has("environment")) {
      notes.push_back(fmt::format("its environment {} is of no level and is not drawn",
                                  shown(meta.at("environment").json())));
    }
  }

 private:
  static void add_counts(const JsonPlace& node, const std::string& level, std::uint64_t file_count,
                         std::map<std::uint64_t, std::uint64_t>& counts) {
    if (node.has("lods") && node.at("lods").has(level)) {
      const JsonPlace lods = node.at("lods");
      const JsonPlace part = lods.at(level);
      const auto file = static_cast<std::uint64_t>(part.at("file").whole());
      if (file >= file_count) part.at("file").refuse("one of filenames");
      part.at("offset").whole();
      counts[file] += static_cast<std::uint64_t>(part.at("count").whole());
    }
    if (!node.has("children")) return;
    for (const JsonPlace& child : node.at("children").elements()) {
      add_counts(child, level, file_count, counts);
    }
  }
};

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

std::vector<std::string> files_of_sog(const std::string& path,
                                      const SceneReadOptions& /*options*/) {
  const std::string meta_path = named_file(path, kSogMeta);
  if (meta_path.empty()) return {path};
  const Json json = read_json(meta_path);
  const JsonPlace meta(meta_path, json);
  std::vector<std::string> files = {meta_path};
  for (const auto& [member, count] : kPictures) {
    if (!meta.has(member)) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string name = file_name(meta.at(member), i);
      files.push_back((fs::path(meta_path).parent_path() / name).string());
    }
  }
  return files;
}

std::vector<std::string> files_of_streamed_sog(const std::string& path,
                                               const SceneReadOptions& options) {
  const Level level(path, options);
  std::vector<std::string> files = {level.meta_path};
  for (const auto& [place, count] : level.parts) {
    const std::vector<std::string> of_part = files_of_sog(place, options);
    files.insert(files.end(), of_part.begin(), of_part.end());
  }
  return files;
}

SceneContents read_streamed_sog(const std::string& path, const SceneReadOptions& options) {
  const Level level(path, options);
  SceneContents all;
  for (const auto& [place, count] : level.parts) {
    SceneContents part = read_sog(place, options);
    if (part.cloud.size() + part.dropped_invalid != count) {
      throw InputError(fmt::format("{}: got {} Gaussians, expected {} as {} says", place,
                                   part.cloud.size() + part.dropped_invalid, count,
                                   level.meta_path));
    }
    append_scene(place, std::move(part), all);
  }
  all.notes.insert(all.notes.end(), level.notes.begin(), level.notes.end());
  return all;
}

}  // namespace sgs
