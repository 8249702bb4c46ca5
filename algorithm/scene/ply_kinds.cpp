// Kinds by names of properties and by comments.
#include "algorithm/scene/ply_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {
namespace {

bool has_element(const PlyHeader& header, std::string_view name) {
  return std::any_of(header.elements.begin(), header.elements.end(),
                     [name](const PlyElement& element) { return element.name == name; });
}

bool has_property(const PlyElement& element, std::string_view name) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [name](const PlyProperty& property) { return property.name == name; });
}

bool begins_with(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what, const char* remedy) {
  throw InputError(
      fmt::format("{}: element vertex: got {}, expected 3D Gaussians: {}", path, what, remedy));
}

// Properties that other kinds of scenes bring beside or instead of those of 3D Gaussians.
struct Kind {
  std::string_view property;
  bool is_prefix;
  const char* what;
  const char* remedy;
};

constexpr const char* kExportPlain = "export it as plain 3D Gaussians";
constexpr const char* kExportOneTime = "export the Gaussians of one time";

constexpr Kind kKinds[] = {
    {"sg_", true, "colours of spherical Gaussians", "train or export it with spherical harmonics"},
    {"f_offset_", true, "anchors of Scaffold-GS", kExportPlain},
    {"f_anchor_feat", true, "anchors of Scaffold-GS", kExportPlain},
    {"beta", false, "Beta kernels", kExportPlain},
    {"sb_params_", true, "colours of Spherical Beta", kExportPlain},
    {"trbf_", true, "Gaussians that move", kExportOneTime},
    {"motion_", true, "Gaussians that move", kExportOneTime},
    {"omega_", true, "Gaussians that move", kExportOneTime},
    {"t", false, "Gaussians that move", kExportOneTime},
    {"scale_t", false, "Gaussians that move", kExportOneTime},
    {"rot_r_", true, "Gaussians that move", kExportOneTime},
};

// In the files of the original, where they mean nothing.
constexpr std::string_view kEmptyProperties[] = {"nx", "ny", "nz"};

bool is_slot(std::string_view name) {
  if (begins_with(name, "f_rest_")) return true;
  for (int slot = 0; slot < kRestSlot; ++slot) {
    if (slot_name(slot) == name) return true;
  }
  return false;
}

// The mode that a comment asks for: "SplatRenderMode: mip" (Brush), "antialiased 1" (Postshot).
std::string render_mode(const PlyHeader& header) {
  std::string mode;
  for (const std::string& comment : header.comments) {
    std::string words;
    for (const char c : comment) {
      if (std::isspace(static_cast<unsigned char>(c)) == 0) {
        words += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      }
    }
    constexpr std::string_view kBrush = "splatrendermode:";
    if (begins_with(words, kBrush)) mode = words.substr(kBrush.size());
    if (words == "antialiased1") mode = "mip";
    if (words == "antialiased0") mode = "default";
  }
  return mode;
}

std::string names_in_short(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kShown ? text + ", ..." : text;
}

void note_skipped(const char* what, const std::vector<std::string>& names,
                  std::vector<std::string>& notes) {
  if (names.empty()) return;
  notes.push_back(fmt::format("{} {} skipped, since no picture needs {}: {}", names.size(), what,
                              names.size() == 1 ? "it" : "them", names_in_short(names)));
}

}  // namespace

bool is_compressed_ply(const PlyHeader& header) {
  const auto vertex =
      std::find_if(header.elements.begin(), header.elements.end(),
                   [](const PlyElement& element) { return element.name == "vertex"; });
  return has_element(header, "chunk") && vertex != header.elements.end() &&
         has_property(*vertex, "packed_position");
}

void refuse_other_kinds(const std::string& path, const PlyHeader& header,
                        const PlyElement& vertex) {
  for (const Kind& kind : kKinds) {
    for (const PlyProperty& property : vertex.properties) {
      if (kind.is_prefix ? begins_with(property.name, kind.property)
                         : property.name == kind.property) {
        refuse(path, fmt::format("{} (property {})", kind.what, property.name), kind.remedy);
      }
    }
  }
  const auto has = [&vertex](const char* name) { return has_property(vertex, name); };
  if (has("x") && !has("opacity") && !has("scale_0") && !has("rot_0")) {
    refuse(path, "a cloud of points without opacity, scale and rotation",
           "it is what a training begins with");
  }
  if ((has("scale_1") && has("rot_0") && !has("scale_2")) || render_mode(header) == "2dgs") {
    refuse(path, "surfels of 2DGS", "they need their own rasteriser; train it as 3DGS");
  }
  if (!has("f_dc_0") && has("red") && has("opacity")) {
    refuse(path, "colours as red, green, blue", "export it with f_dc_0..2");
  }
}

bool is_antialiased(const PlyHeader& header) { return render_mode(header) == "mip"; }

std::vector<std::string> notes_on_ply(const PlyHeader& header, const PlyElement& vertex) {
  std::vector<std::string> notes, properties, elements;
  for (const PlyProperty& property : vertex.properties) {
    const bool is_empty = std::find(std::begin(kEmptyProperties), std::end(kEmptyProperties),
                                    property.name) != std::end(kEmptyProperties);
    if (property.name == kFilterProperty) {
      notes.push_back(fmt::format("{} is baked into scales and opacities", kFilterProperty));
    } else if (!is_empty && !is_slot(property.name)) {
      properties.push_back(property.name);
    }
  }
  for (const PlyElement& element : header.elements) {
    if (element.name != vertex.name) elements.push_back(element.name);
  }
  note_skipped(properties.size() == 1 ? "property is" : "properties are", properties, notes);
  note_skipped(elements.size() == 1 ? "element is" : "elements are", elements, notes);
  if (is_antialiased(header)) notes.emplace_back(kAntialiasedNote);
  return notes;
}

}  // namespace sgs
