// The order of the reference renderer; drawing of any order.
#include "algorithm/tune/group_sequences.h"

#include <tbb/parallel_for.h>

#include <utility>

#include "algorithm/render/group_state.h"
#include "algorithm/render/splat_bins.h"
#include "algorithm/render/splat_sequence.h"

namespace sgs {
namespace {

// Any multiple of 4 gives the same picture. Next to the renderer's tiles of 16 px a splat falls on
// fewer groups, which spares a twelfth of the time; with 64 px too few are left for many threads.
constexpr int kGroupPx = 32;

}  // namespace

GroupSequences reference_sequences(const View<float>& view, const ActivatedCloud& cloud) {
  GroupSequences out;
  out.width = view.width;
  out.height = view.height;
  SplatSequence sequence(view, cloud);
  sequence.next(sequence.keys().size(), out.splats);
  out.groups = pixel_groups(view.width, view.height, square_of(kGroupPx));
  SplatBins bins = bin_splats(cell_grid(view.width, view.height, square_of(kGroupPx)),
                              out.splats.data(), out.splats.size());
  out.first = std::move(bins.first);
  out.entries = std::move(bins.entries);
  return out;
}

RenderResult draw(const GroupSequences& sequences, const glm::vec3& background,
                  BlendPrecision precision) {
  RenderResult result;
  result.image = Image(sequences.width, sequences.height);
  result.transmittance.resize(result.image.pixels.size());
  result.contributors.resize(result.image.pixels.size());
  tbb::parallel_for(std::size_t{0}, sequences.groups.size(), [&](std::size_t group) {
    GroupState state(sequences.groups[group], sequences.width, sequences.height, precision);
    for (std::size_t i = sequences.first[group]; i != sequences.first[group + 1]; ++i) {
      if (state.saturated()) break;
      state.blend(sequences.splat_of(i));
    }
    state.store(background, result);
  });
  return result;
}

}  // namespace sgs
