// The numbers of a glTF 2.0 file: its JSON, buffers, views and accessors.
#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/files/input_json.h"

namespace sgs {

// Numbers of an accessor; integers that are normalised come out in [-1, 1].
struct GltfAccessor {
  std::uint64_t count = 0;
  int components = 0;  // of each
  std::uint64_t stride_bytes = 0;
  std::uint32_t type = 0;  // of a component, as glTF numbers them
  bool normalised = false;
  const char* bytes = nullptr;

  double at(std::uint64_t index, int component) const;
};

class GltfBuffers {
 public:
  // Throws InputError for what is no glTF 2.0.
  explicit GltfBuffers(const std::string& path);
  GltfBuffers(const GltfBuffers&) = delete;
  GltfBuffers& operator=(const GltfBuffers&) = delete;

  // Member number `index` of the list `name` of the file. Throws InputError where there is none.
  JsonPlace item(const std::string& name, std::uint64_t index) const;
  std::uint64_t count(const std::string& name) const;
  const std::vector<std::string>& files() const { return files_; }  // that were opened
  const JsonPlace& root() const { return *root_; }

  // Both as long as this lives. Throw InputError for what does not lie within its buffer, and for
  // compressed and sparse ones.
  std::string_view view(std::uint64_t index) const;
  GltfAccessor accessor(std::uint64_t index, int components) const;

 private:
  void read_glb();
  std::string_view buffer_bytes(std::uint64_t index);

  std::string path_;
  std::vector<std::string> files_;
  std::string file_;
  std::string_view binary_;  // the binary chunk of a .glb
  nlohmann::ordered_json json_;
  std::optional<JsonPlace> root_;
  std::deque<std::string> others_;  // bytes that do not stand in the file itself
  std::vector<std::string_view> buffers_;
};

}  // namespace sgs
