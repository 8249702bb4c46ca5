// The blend pass with nobody looking.
#include "algorithm/render/reference_renderer.h"

#include "algorithm/render/blend_pass.h"

namespace sgs {

RenderResult render_reference(const View<float>& view, const ActivatedCloud& cloud,
                              const glm::vec3& background) {
  const std::vector<GroupState> tiles =
      blend_scene(view, cloud, [](GroupState& tile, const Splat& splat) { tile.blend(splat); });
  RenderResult result;
  result.image = Image(view.width, view.height);
  result.transmittance.resize(result.image.pixels.size());
  result.contributors.resize(result.image.pixels.size());
  for (const GroupState& tile : tiles) tile.store(background, result);
  return result;
}

}  // namespace sgs
