// Kinds of ply_header.h, by names of properties and by comments.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {
namespace {

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

// The mode that a comment asks for: "SplatRenderMode: mip" (Brush), "antialiased 1" or
// "postshot.anti_aliasing=1" (Postshot).
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
    for (const char* postshot : {"antialiased", "postshot.anti_aliasing="}) {
      if (words == std::string(postshot) + "1") mode = "mip";
      if (words == std::string(postshot) + "0") mode = "default";
    }
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
  const PlyElement* const vertex = header.element("vertex");
  return header.element("chunk") != nullptr && vertex != nullptr && vertex->has("packed_position");
}

void refuse_other_kinds(const std::string& path, const PlyHeader& header) {
  const PlyElement& vertex = *header.element("vertex");
  for (const Kind& kind : kKinds) {
    for (const PlyProperty& property : vertex.properties) {
      if (kind.is_prefix ? begins_with(property.name, kind.property)
                         : property.name == kind.property) {
        refuse(path, fmt::format("{} (property {})", kind.what, property.name), kind.remedy);
      }
    }
  }
  const auto has = [&vertex](const char* name) { return vertex.has(name); };
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

std::vector<std::string> notes_on_ply(const PlyHeader& header,
                                      const std::map<std::string, std::set<std::string>>& read) {
  std::vector<std::string> notes, properties, elements;
  bool antialiased = render_mode(header) == "mip";
  for (const PlyElement& element : header.elements) {
    const auto of_element = read.find(element.name);
    if (of_element == read.end()) {
      elements.push_back(element.name);
      continue;
    }
    for (const PlyProperty& property : element.properties) {
      if (of_element->second.count(property.name) == 0) {
        properties.push_back(property.name);
      } else if (property.name == kFilterProperty) {
        notes.push_back(fmt::format("{} is baked into scales and opacities", kFilterProperty));
        antialiased = true;
      }
    }
  }
  note_skipped(properties.size() == 1 ? "property is" : "properties are", properties, notes);
  note_skipped(elements.size() == 1 ? "element is" : "elements are", elements, notes);
  if (antialiased) notes.emplace_back(kAntialiasedNote);
  return notes;
}

}  // namespace sgs
