// Expectations slot by slot, and random shares.
#include "testbench/units/hfu_plan.h"

#include <algorithm>
#include <utility>

#include "algorithm/memory/record_split.h"
#include "algorithm/splat/make_splat.h"

namespace sgs::tb {
namespace {

SplitFirstHalf first_half_of(const TestScene& scene, std::uint32_t slot) {
  const SceneLayout& layout = scene.job.layout;
  return read_first_half(layout.split, scene.image.at(layout.first_halves.address(slot)));
}

DecodedGaussian decode_slot(const TestScene& scene, std::uint32_t slot) {
  const SceneLayout& layout = scene.job.layout;
  const MemoryImage& image = scene.image;
  const SplitFirstHalf first = first_half_of(scene, slot);
  return read_record(layout.split, layout.second_half, first.mean, first.carried,
                     image.at(layout.second_halves.address(slot)), image.at(layout.codebooks.base));
}

// Lines that hold a byte of one of the record's entries, counted entry by entry.
std::uint32_t lines_of(const HfuPlan& plan, std::uint32_t slot) {
  const SceneLayout& layout = plan.scene.job.layout;
  const SecondHalfFormat& format = layout.second_half;
  const CodebookIndices indices =
      read_indices(layout.split, format, first_half_of(plan.scene, slot).carried,
                   plan.scene.image.at(layout.second_halves.address(slot)));
  std::uint32_t lines = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const EntryRange range = format.entry(static_cast<Codebook>(id), indices[id]);
    const std::uint32_t end = range.begin + range.bytes;
    for (std::uint32_t line = 0; line < format.codebook_bytes(); line += plan.codebook.line_bytes) {
      lines += line < end && line + plan.codebook.line_bytes > range.begin ? 1 : 0;
    }
  }
  return lines;
}

}  // namespace

ExpectedShare expect(const HfuPlan& plan, const VisitShare& share) {
  ExpectedShare out;
  const TestScene& scene = plan.scene;
  const PixelRect& pixels = scene.job.groups[share.group];
  for (std::uint32_t slot = share.first; slot < share.first + share.count; ++slot) {
    const DecodedGaussian decoded = decode_slot(scene, slot);
    const Gaussian<float>& g = decoded.gaussian;
    const bool near = touches(
        bound_first_half(scene.job.layout.split, first_half_of(scene, slot), scene.job.view),
        pixels);
    out.passes.push_back(near || !plan.config.coarse_filter);
    if (scene.job.layout.second_half.quantised()) out.lines.push_back(lines_of(plan, slot));
    Splat splat{};
    // A Gaussian that the coarse filter would drop must not come through the fine one either.
    if (!near || !make_geometry(scene.job.view, g, splat) || !reaches_group(splat, pixels))
      continue;
    add_colour(scene.job.view, scene.job.layout.sh_degree(), g.mean, decoded.sh, splat);
    splat.index = slot;
    out.splats.push_back(splat);
  }
  return out;
}

HfuPlan hfu_plan_of(TestScene scene) {
  HfuPlan plan;
  plan.scene = std::move(scene);
  return plan;
}

void add_shares(std::mt19937_64& random, HfuPlan& plan, std::size_t visits, std::uint32_t most) {
  const std::uint32_t stored = plan.scene.job.layout.gaussian_count();
  std::uint32_t number = 0;
  for (std::uint32_t group = 0; group < plan.scene.job.groups.size(); ++group) {
    for (std::size_t left = visits; left > 0; --left) {
      const auto count = static_cast<std::uint32_t>(random() % (std::min(stored, most) + 1));
      const auto first = static_cast<std::uint32_t>(random() % (stored - count + 1));
      plan.shares.push_back({group, number++, first, count, Mark::kEndOfVisit});
    }
    plan.shares.push_back({group, number++, 0, 0, Mark::kEndOfGroup});
  }
}

}  // namespace sgs::tb
