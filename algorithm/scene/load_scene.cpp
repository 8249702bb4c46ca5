// The choice of the source for load_scene.h.
#include "algorithm/scene/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "algorithm/input_error.h"
#include "algorithm/scene/builtin_scene.h"

namespace sgs {

Scene load_scene(const std::string& spec, const PlyReadOptions& options) {
  if (is_builtin_scene(spec)) {
    BuiltinScene made = make_builtin_scene(spec);
    const std::size_t begin = spec.find(':') + 1;
    return {spec.substr(begin, spec.find('?') - begin), std::move(made.cloud),
            std::move(made.cameras), 0};
  }
  const std::filesystem::path path(spec);
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".ply") {
    throw InputError(fmt::format(
        "{}: got the extension \"{}\", expected a .ply file or builtin:NAME", spec, extension));
  }
  PlyReadResult read = read_ply(spec, options);
  return {path.stem().string(), std::move(read.cloud), {}, read.dropped_invalid};
}

}  // namespace sgs
