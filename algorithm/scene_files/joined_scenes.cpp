// Column by column.
#include "algorithm/scene_files/joined_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "algorithm/files/input_error.h"

namespace sgs {

void append_scene(const std::string& origin, SceneContents&& more, SceneContents& all) {
  GaussianCloud &to = all.cloud, &from = more.cloud;
  if (to.size() == 0) to.sh_degree = from.sh_degree;
  if (from.size() > 0 && to.sh_degree != from.sh_degree) {
    throw InputError(fmt::format("{}: got SH degree {}, expected {} as in the parts before it",
                                 origin, from.sh_degree, to.sh_degree));
  }
  const auto add = [](auto& column, const auto& values) {
    column.insert(column.end(), values.begin(), values.end());
  };
  add(to.means, from.means);
  add(to.log_scales, from.log_scales);
  add(to.quats, from.quats);
  add(to.opacity_logits, from.opacity_logits);
  add(to.sh_coeffs, from.sh_coeffs);
  all.dropped_invalid += more.dropped_invalid;
  for (std::string& note : more.notes) {
    if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) {
      all.notes.push_back(std::move(note));
    }
  }
}

}  // namespace sgs
