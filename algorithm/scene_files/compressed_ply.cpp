// Columns of the three elements of a compressed PLY (scene_forms.h), and the numbers in their
// words.
#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/scene_forms.h"

namespace sgs {
namespace {

constexpr std::uint64_t kChunkGaussians = 256;

const char* type_name(PlyScalar type) {
  return type == PlyScalar::kFloat32 ? "float" : type == PlyScalar::kUint32 ? "uint" : "uchar";
}

// The records of one element.
class Records {
 public:
  Records(const InputFile& file, PlyFormat format, const PlyElement& element,
          std::uint64_t offset_bytes)
      : format_(format), element_(element), record_bytes_(element.record_bytes()) {
    bytes_ = file.text_from(offset_bytes, element.count * record_bytes_);
  }

  struct Column {
    std::uint64_t offset_bytes = 0;
    PlyScalar type = PlyScalar::kFloat32;
  };

  // Throws InputError where it is missing or of another type.
  Column column(const std::string& path, const std::string& name, PlyScalar type) {
    names_.insert(name);
    std::uint64_t offset_bytes = 0;
    for (const PlyProperty& property : element_.properties) {
      if (property.name == name && property.type == type) return {offset_bytes, type};
      offset_bytes += size_bytes(property.type);
    }
    throw InputError(
        fmt::format("{}: element {}: got no property {} {}, expected it in a "
                    "compressed PLY",
                    path, element_.name, type_name(type), name));
  }
  const std::set<std::string>& names() const { return names_; }  // of the columns

  template <class T>
  T at(std::uint64_t record, const Column& column) const {
    return load_ply_scalar<T>(format_, &bytes_[record * record_bytes_ + column.offset_bytes],
                              column.type);
  }

 private:
  PlyFormat format_;
  const PlyElement& element_;
  std::uint64_t record_bytes_;
  std::string bytes_;
  std::set<std::string> names_;
};

double unsigned_part(std::uint32_t word, int shift, int bits) {
  const std::uint32_t most = (1U << bits) - 1;
  return static_cast<double>((word >> shift) & most) / most;
}

double between(double low, double high, double share) { return low * (1 - share) + high * share; }

// Of three axes: 11, 10 and 11 bits.
std::array<double, 3> axis_shares(std::uint32_t word) {
  return {unsigned_part(word, 21, 11), unsigned_part(word, 11, 10), unsigned_part(word, 0, 11)};
}

void decode_rotation(std::uint32_t word, float* rotation) {
  const double length = 1.0 / (std::sqrt(2.0) * 0.5);
  int shift = 30;
  decode_smallest_three(
      {0, 1, 2, 3}, static_cast<int>(word >> 30),
      [&] {
        shift -= 10;
        return (unsigned_part(word, shift, 10) - 0.5) * length;
      },
      rotation);
}

// Three pairs of columns of the element chunk.
struct Bounds {
  std::array<Records::Column, 3> low, high;

  Bounds(const std::string& path, Records& chunks, const std::array<const char*, 3>& names) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = chunks.column(path, fmt::format("min_{}", names[i]), PlyScalar::kFloat32);
      high[i] = chunks.column(path, fmt::format("max_{}", names[i]), PlyScalar::kFloat32);
    }
  }
  double at(const Records& chunks, std::uint64_t chunk, std::size_t i, double share) const {
    return between(chunks.at<float>(chunk, low[i]), chunks.at<float>(chunk, high[i]), share);
  }
};

int degree_of(const std::string& path, std::size_t coefficients) {
  for (int degree = 0; degree <= 3; ++degree) {
    if (coefficients == 3 * static_cast<std::size_t>(rest_coeff_count(degree))) return degree;
  }
  throw InputError(
      fmt::format("{}: element sh: got {} properties, expected 9, 24 or 45 (SH degree 1 to 3)",
                  path, coefficients));
}

}  // namespace

SceneContents read_compressed_ply(const std::string& path, const SceneReadOptions& options) {
  const InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  if (header.format == PlyFormat::kAscii) {
    throw InputError(fmt::format("{}: got a compressed PLY as text, expected a binary one", path));
  }
  refuse_other_kinds(path, header);
  const PlyElement& chunk = *header.element("chunk");
  const PlyElement& vertex = *header.element("vertex");
  const PlyElement* const sh = header.element("sh");
  std::uint64_t offset_bytes = header.body_offset_bytes;
  std::map<std::string, std::uint64_t> offsets;
  for (const PlyElement& element : header.elements) {
    if (element.has_lists()) {
      throw InputError(
          fmt::format("{}: element {}: got a list, expected scalars only", path, element.name));
    }
    offsets[element.name] = offset_bytes;
    offset_bytes += element.count * element.record_bytes();  // the header fits the file
  }
  if (offset_bytes != file.size_bytes()) {
    throw InputError(
        fmt::format("{}: byte {}: got {} bytes after the last record, expected the end of the file",
                    path, offset_bytes, file.size_bytes() - offset_bytes));
  }
  const std::uint64_t count = vertex.count;
  if (chunk.count != (count + kChunkGaussians - 1) / kChunkGaussians ||
      (sh != nullptr && sh->count != count)) {
    throw InputError(
        fmt::format("{}: got {} Gaussians, {} chunks and {} sh, expected a chunk for "
                    "{} Gaussians and as many sh",
                    path, count, chunk.count, sh != nullptr ? sh->count : 0, kChunkGaussians));
  }

  Records chunks(file, header.format, chunk, offsets["chunk"]);
  Records vertices(file, header.format, vertex, offsets["vertex"]);
  const PlyElement none;
  Records coefficients(file, header.format, sh != nullptr ? *sh : none, offsets["sh"]);
  const int degree = sh != nullptr ? degree_of(path, sh->properties.size()) : 0;
  std::vector<Records::Column> rest;
  for (int k = 0; k < 3 * rest_coeff_count(degree); ++k) {
    rest.push_back(coefficients.column(path, slot_name(kRestSlot + k), PlyScalar::kUint8));
  }
  const auto word = [&](const char* name) {
    return vertices.column(path, name, PlyScalar::kUint32);
  };
  const Records::Column position = word("packed_position"), rotation = word("packed_rotation"),
                        scale = word("packed_scale"), colour = word("packed_color");
  const Bounds positions(path, chunks, {"x", "y", "z"});
  const Bounds scales(path, chunks, {"scale_x", "scale_y", "scale_z"});
  std::optional<Bounds> colours;
  if (chunk.has("min_r")) colours.emplace(path, chunks, std::array<const char*, 3>{"r", "g", "b"});

  SceneContents contents =
      decoded_scene(path, count, degree, options, [&](std::uint64_t index, float* slots) {
        const std::uint64_t block = index / kChunkGaussians;
        const auto place = axis_shares(vertices.at<std::uint32_t>(index, position));
        const auto size = axis_shares(vertices.at<std::uint32_t>(index, scale));
        const auto rgba = vertices.at<std::uint32_t>(index, colour);
        for (std::size_t i = 0; i < 3; ++i) {
          slots[kMeanSlot + i] = static_cast<float>(positions.at(chunks, block, i, place[i]));
          slots[kScaleSlot + i] = static_cast<float>(scales.at(chunks, block, i, size[i]));
          double share = unsigned_part(rgba, 24 - 8 * static_cast<int>(i), 8);
          if (colours) share = colours->at(chunks, block, i, share);
          slots[kDcSlot + i] = static_cast<float>(dc_of_colour(share));
        }
        decode_rotation(vertices.at<std::uint32_t>(index, rotation), slots + kRotationSlot);
        slots[kOpacitySlot] = static_cast<float>(-std::log(1 / unsigned_part(rgba, 0, 8) - 1));
        for (std::size_t k = 0; k < rest.size(); ++k) {
          // The middle of its interval, but for the ends.
          const int byte = coefficients.at<std::uint8_t>(index, rest[k]);
          const double share = byte == 0 ? 0 : byte == 255 ? 1 : (byte + 0.5) / 256;
          slots[kRestSlot + k] = static_cast<float>((share - 0.5) * 8);
        }
      });
  contents.notes = notes_on_ply(
      header,
      {{"chunk", chunks.names()}, {"vertex", vertices.names()}, {"sh", coefficients.names()}});
  return contents;
}

}  // namespace sgs
