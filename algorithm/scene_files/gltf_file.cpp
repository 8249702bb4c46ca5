// Nodes, primitives and attributes of glTF (scene_forms.h).
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/scene_files/assembled_scene.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/gltf_buffers.h"
#include "algorithm/scene_files/scene_forms.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExtension = "KHR_gaussian_splatting";
constexpr const char* kSpzExtension = "KHR_gaussian_splatting_compression_spz_2";

glm::dmat4 local_matrix(const JsonPlace& node) {
  if (node.has("matrix")) {
    const std::vector<double> values = node.at("matrix").numbers(16);  // column by column
    glm::dmat4 matrix(1);
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = values[i];
    return matrix;
  }
  glm::dmat4 matrix(1);
  if (node.has("translation")) {
    const std::vector<double> t = node.at("translation").numbers(3);
    matrix = glm::translate(matrix, glm::dvec3(t[0], t[1], t[2]));
  }
  if (node.has("rotation")) {
    const std::vector<double> q = node.at("rotation").numbers(4);
    matrix = matrix * glm::mat4_cast(glm::normalize(glm::dquat(q[3], q[0], q[1], q[2])));
  }
  if (node.has("scale")) {
    const std::vector<double> s = node.at("scale").numbers(3);
    matrix = glm::scale(matrix, glm::dvec3(s[0], s[1], s[2]));
  }
  return matrix;
}

// The attributes of a primitive that is not compressed.
struct Attributes {
  GltfAccessor position, rotation, scale, opacity;
  std::vector<GltfAccessor> sh;  // one a coefficient
  int degree = 0;

  Attributes(const GltfBuffers& buffers, const JsonPlace& fields) {
    const auto accessor = [&](const std::string& name, int components) {
      const GltfAccessor found = buffers.accessor(fields.at(name).whole(), components);
      if (name != "POSITION" && found.count != position.count) {
        fields.at(name).refuse(fmt::format("an accessor of {} as POSITION", position.count));
      }
      return found;
    };
    const std::string prefix = std::string(kExtension) + ":";
    position = accessor("POSITION", 3);
    rotation = accessor(prefix + "ROTATION", 4);
    scale = accessor(prefix + "SCALE", 3);
    opacity = accessor(prefix + "OPACITY", 1);
    const auto name_of = [&](int band, int number) {
      return fmt::format("{}SH_DEGREE_{}_COEF_{}", prefix, band, number);
    };
    if (fields.has(name_of(4, 0))) fields.at(name_of(4, 0)).refuse("SH of degree 3 at most");
    for (int band = 1; band <= 3; ++band) {
      for (int k = 0; k < 2 * band + 1; ++k) {
        if (fields.has(name_of(band, k))) degree = band;
      }
    }
    // A degree comes whole, with all below it.
    for (int band = 0; band <= degree; ++band) {
      for (int k = 0; k < 2 * band + 1; ++k) sh.push_back(accessor(name_of(band, k), 3));
    }
    refuse_logarithms(fields.at(prefix + "SCALE"));
  }

  // Drafts of the extension had logarithms.
  void refuse_logarithms(const JsonPlace& place) const {
    for (std::uint64_t i = 0; i < scale.count; ++i) {
      for (int k = 0; k < 3; ++k) {
        if (!(scale.at(i, k) < 0)) continue;
        place.refuse(fmt::format("a scale of {} of Gaussian {}", scale.at(i, k), i),
                     "none below 0: drafts of the extension had logarithms, so export it again");
      }
    }
  }

  void fill(std::uint64_t index, float* slots) const {
    for (int i = 0; i < 3; ++i) {
      slots[kMeanSlot + i] = static_cast<float>(position.at(index, i));
      slots[kScaleSlot + i] = static_cast<float>(std::log(scale.at(index, i)));
      slots[kDcSlot + i] = static_cast<float>(sh[0].at(index, i));
      for (std::size_t k = 1; k < sh.size(); ++k) {
        slots[rest_slot(degree, i, static_cast<int>(k) - 1)] =
            static_cast<float>(sh[k].at(index, i));
      }
    }
    for (int k = 0; k < 4; ++k) {
      slots[kRotationSlot + k] = static_cast<float>(rotation.at(index, (k + 3) % 4));
    }
    slots[kOpacitySlot] = static_cast<float>(logit(opacity.at(index, 0)));
  }
};

void check_kind(const JsonPlace& splats) {
  const auto check = [&](const char* name, const char* expected) {
    const auto found = splats.find(name);
    if (found && found->text() != expected) found->refuse(fmt::format("\"{}\"", expected));
  };
  check("kernel", "ellipse");
  check("colorSpace", "srgb_rec709_display");
  check("projection", "perspective");
  check("sortingMethod", "cameraDistance");
}

// What a file may ask of its reader. Quantised accessors are read as all others.
void check_required(const JsonPlace& root) {
  if (!root.has("extensionsRequired")) return;
  const std::vector<std::string> known = {kExtension, kSpzExtension, "KHR_mesh_quantization"};
  for (const std::string& name : root.at("extensionsRequired").texts()) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError(fmt::format("{}: extensionsRequired: got {}, expected none but {}",
                                 root.name(), name, join(known)));
  }
}

class GltfReader {
 public:
  GltfReader(const std::string& path, const SceneReadOptions& options)
      : path_(path), options_(options), buffers_(path), seen_(buffers_.count("nodes"), false) {}

  SceneContents read() {
    // glTF has its y axis upward: half a turn about z.
    const glm::dmat4 axes(glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, 1, 0),
                          glm::dvec4(0, 0, 0, 1));
    if (buffers_.count("scenes") == 0) {
      throw InputError(fmt::format("{}: got no scene, expected one", path_));
    }
    check_required(buffers_.root());
    const JsonPlace scene = buffers_.item("scenes", buffers_.root().whole_or("scene", 0));
    queue(scene, "nodes", axes);
    while (!queued_.empty()) {
      const auto [index, parent] = queued_.back();
      queued_.pop_back();
      add_node(index, parent);
    }
    if (primitives_ == 0) {
      throw InputError(fmt::format("{}: got no primitive with {}, expected Gaussians{}", path_,
                                   kExtension, others_ > 0 ? "; it holds meshes or points" : ""));
    }
    if (others_ > 0) {
      contents_.notes.push_back(
          fmt::format("{} primitives without {} are skipped", others_, kExtension));
    }
    contents_.notes.emplace_back(
        "it asks for an order by distance from the camera; Gaussians are drawn by depth, as the "
        "original draws them");
    return std::move(contents_);
  }

 private:
  // The nodes that a member names, the first to be taken next.
  void queue(const JsonPlace& owner, const char* member, const glm::dmat4& parent) {
    if (!owner.has(member)) return;
    const std::vector<JsonPlace> nodes = owner.at(member).elements();
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      queued_.emplace_back(node->whole(), parent);
    }
  }

  void add_node(std::uint64_t index, const glm::dmat4& parent) {
    const JsonPlace node = buffers_.item("nodes", index);
    if (seen_[index]) {
      throw InputError(fmt::format("{}: got it twice in the tree, expected once", node.name()));
    }
    seen_[index] = true;
    const glm::dmat4 matrix = parent * local_matrix(node);
    if (node.has("mesh")) add_mesh(node, matrix);
    queue(node, "children", matrix);
  }

  void add_mesh(const JsonPlace& node, const glm::dmat4& matrix) {
    const JsonPlace mesh = buffers_.item("meshes", node.at("mesh").whole());
    std::uint64_t number = 0;
    for (const JsonPlace& element : mesh.at("primitives").elements()) {
      const JsonPlace primitive(fmt::format("{}: primitive {}", mesh.name(), number++),
                                element.json());
      if (!primitive.has("extensions") || !primitive.at("extensions").has(kExtension)) {
        ++others_;
        continue;
      }
      ++primitives_;
      const std::optional<Placement> placement = Placement::of(matrix);
      if (!placement) {
        throw InputError(
            fmt::format("{}: got a transform that does more than turn, move and scale alike, "
                        "expected it applied to the Gaussians",
                        node.name()));
      }
      append_scene(primitive.name(), read_primitive(primitive, *placement), contents_);
    }
  }

  SceneContents read_primitive(const JsonPlace& primitive, const Placement& placement) const {
    const JsonPlace extensions = primitive.at("extensions");
    const JsonPlace splats = extensions.at(kExtension);
    check_kind(splats);
    const std::string origin = primitive.name();
    if (!splats.has("extensions")) {
      const Attributes attributes(buffers_, primitive.at("attributes"));
      return decoded_scene(origin, attributes.position.count, attributes.degree, options_,
                           [&](std::uint64_t index, float* slots) {
                             attributes.fill(index, slots);
                             placement.apply(attributes.degree, slots);
                           });
    }
    const JsonPlace compression = splats.at("extensions");
    if (!compression.has(kSpzExtension)) {
      splats.at("extensions").refuse(fmt::format("none, or {}", kSpzExtension));
    }
    const std::string_view spz =
        buffers_.view(compression.at(kSpzExtension).at("bufferView").whole());
    SceneContents stored = read_spz_bytes(origin, spz, options_);
    if (!stored.axes.empty()) {
      throw InputError(fmt::format("{}: got an SPZ that states the axes {}, expected those of glTF",
                                   origin, stored.axes));
    }
    return placed(origin, std::move(stored), placement, options_);
  }

  const std::string& path_;
  const SceneReadOptions& options_;
  const GltfBuffers buffers_;
  std::vector<bool> seen_;                                    // of the nodes
  std::vector<std::pair<std::uint64_t, glm::dmat4>> queued_;  // with their parents' matrices
  SceneContents contents_;
  int primitives_ = 0, others_ = 0;
};

}  // namespace

SceneContents read_gltf(const std::string& path, const SceneReadOptions& options) {
  return GltfReader(path, options).read();
}

std::vector<std::string> files_of_gltf(const std::string& path,
                                       const SceneReadOptions& /*options*/) {
  return GltfBuffers(path).files();
}

}  // namespace sgs
