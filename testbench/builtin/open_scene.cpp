// The choice of the source for open_scene.h.
#include "testbench/builtin/open_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "algorithm/files/input_error.h"
#include "testbench/builtin/builtin_scene.h"

namespace sgs {

Scene open_scene(const std::string& spec, const SceneReadOptions& options) {
  if (is_builtin_scene(spec)) {
    if (options.level || !options.axes.empty()) {
      throw InputError(fmt::format(
          "{}: got {}, expected none: it is made, not read", spec,
          options.level ? fmt::format("level {}", *options.level) : "the axes " + options.axes));
    }
    BuiltinScene made = make_builtin_scene(spec);
    const std::size_t begin = spec.find(':') + 1;
    return {spec.substr(begin, spec.find('?') - begin), std::move(made.cloud),
            std::move(made.cameras), 0};
  }
  std::error_code unknown;
  if (!std::filesystem::exists(spec, unknown)) {
    throw InputError(fmt::format("{}: no such file, expected a scene ({}) or builtin:NAME", spec,
                                 scene_endings()));
  }
  return load_scene(spec, options);
}

}  // namespace sgs
