// Chunks and accessors of glTF.
#include <fmt/format.h>

#include "tests/algorithm/scene_files/made_scene_files.h"

namespace sgs::test {

std::string glb_of(const std::string& json, const std::string& binary) {
  const auto padded = [](std::string text, char with) {
    text.resize((text.size() + 3) / 4 * 4, with);
    return text;
  };
  const std::string first = padded(json, ' '), second = padded(binary, '\0');
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(12 + 8 + first.size() + 8 + second.size()));
  put(bytes, static_cast<std::uint32_t>(first.size()));
  bytes += "JSON" + first;
  put(bytes, static_cast<std::uint32_t>(second.size()));
  return bytes + std::string("BIN\0", 4) + second;
}

namespace {

constexpr const char* kFront =
    R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0{}}}], "buffers": [{{"byteLength": {}}}], "bufferViews": [{}],
"accessors": [{}], "meshes": [{{"primitives": [{{"mode": 0, "attributes": {{{}}},
"extensions": {{"KHR_gaussian_splatting": {{"kernel": "ellipse",
"colorSpace": "srgb_rec709_display"{}}}}}}}]}}]}})";

}  // namespace

std::string glb_bytes(std::size_t count, int degree, const std::string& node) {
  std::string binary, views, accessors, attributes;
  int number = 0;
  const auto add = [&](const std::string& name, const char* type, auto value, int components) {
    const std::size_t begin = binary.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < components; ++k) put(binary, static_cast<float>(value(i, k)));
    }
    const char* comma = number == 0 ? "" : ",";
    views += fmt::format(R"({}{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", comma, begin,
                         binary.size() - begin);
    accessors +=
        fmt::format(R"({}{{"bufferView": {}, "componentType": 5126, "count": {}, "type": "{}"}})",
                    comma, number, count, type);
    attributes += fmt::format(R"({}"{}": {})", comma, name, number++);
  };
  const std::string prefix = "KHR_gaussian_splatting:";
  const auto x = [](std::size_t i) { return static_cast<double>(i); };
  add(
      "POSITION", "VEC3", [&](auto i, int k) { return (k + 1) * x(i); }, 3);
  add(
      prefix + "ROTATION", "VEC4", [](auto, int k) { return k == 2 ? -0.5 : 0.5; }, 4);
  add(
      prefix + "SCALE", "VEC3", [](auto, int k) { return k == 0   ? 0.5
                                                         : k == 1 ? 0.25
                                                                  : 2.0; }, 3);
  add(
      prefix + "OPACITY", "SCALAR", [](auto i, int) { return code(i, 0) / 255.0; }, 1);
  int coeff = 0;
  for (int band = 0; band <= degree; ++band) {
    for (int k = 0; k < 2 * band + 1; ++k, ++coeff) {
      add(
          fmt::format("{}SH_DEGREE_{}_COEF_{}", prefix, band, k), "VEC3",
          [&](auto i, int channel) { return x(i) + coeff + channel / 4.0; }, 3);
    }
  }
  return glb_of(fmt::format(kFront, node, binary.size(), views, accessors, attributes, ""), binary);
}

std::string spz_glb_bytes(const std::string& spz) {
  const std::string view = fmt::format(R"({{"buffer": 0, "byteLength": {}}})", spz.size());
  return glb_of(
      fmt::format(
          kFront, "", spz.size(), view, "", "",
          R"(, "extensions": {"KHR_gaussian_splatting_compression_spz_2": {"bufferView": 0}})"),
      spz);
}

}  // namespace sgs::test
