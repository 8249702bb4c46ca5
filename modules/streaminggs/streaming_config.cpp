// Checks and derived parameters of a streaming machine that both orders share.
#include "modules/streaminggs/streaming_config.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/files/input_error.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/render/group_shape.h"
#include "algorithm/splat/constants.h"

namespace sgs {

// Each part of a group has its share of everything behind the fetch.
void check_parts(const StreamingConfig& c) {
  const std::uint32_t parts = c.parts_of_group();
  if (parts_across(parts) == 0 || parts > kMostParts) {
    throw InputError(
        fmt::format("hfus: got {} with fetch shared, expected a square number up to {}: each has "
                    "its part of a group",
                    parts, kMostParts));
  }
  for (const auto& [key, value] :
       {std::pair{"rendering.clusters", c.rendering.clusters},
        {"rendering.begin_lanes", c.rendering.begin_lanes},
        {"rendering.span_lanes", c.rendering.span_lanes},
        {"rendering.drain_pixels_per_cycle", c.rendering.drain_pixels_per_cycle}}) {
    if (value % parts != 0) {
      throw InputError(fmt::format("{}: got {} with fetch shared, expected a multiple of hfus {}",
                                   key, value, parts));
    }
  }
}

BuiltFor built_for(const StreamingConfig& config, const StorageConfig& storage) {
  constexpr int kMostDegree = 3;
  BuiltFor out;
  out.group = config.group();
  out.frame_format = config.framebuffer;
  out.second_half = storage.widest_format(kMostDegree);
  for (int degree = 0; degree <= kMostDegree; ++degree) {
    const RecordSplit split = split_of(storage.order, storage.widest_format(degree));
    out.first_half_bytes = std::max(out.first_half_bytes, split.first_bytes());
    out.second_half_bytes = std::max(out.second_half_bytes, split.second_bytes);
    out.fine_records.push_back(split.fine_record(degree));
  }
  out.chunk_gaussians = storage.chunk_gaussians;
  out.splats = config.splats;
  out.eyes = config.hfu.eyes;
  out.memory_port = config.memory_port;
  out.single = config.single_latencies();
  out.half = config.half_latencies();
  return out;
}

RenderingConfig rendering_of_part(const StreamingConfig& c) {
  RenderingConfig part = c.rendering;
  part.clusters /= c.parts_of_group();
  part.begin_lanes /= c.parts_of_group();
  part.span_lanes /= c.parts_of_group();
  part.span_slots = (part.span_slots + c.parts_of_group() - 1) / c.parts_of_group();
  part.drain_pixels_per_cycle /= c.parts_of_group();
  return part;
}

BuiltFor built_for_part(const StreamingConfig& c, BuiltFor built_for) {
  built_for.group = part_size(built_for.group, c.parts_of_group());
  return built_for;
}

void check(const StreamingConfig& c, const StorageConfig& storage) {
  for (const auto& [key, px] :
       {std::pair{"group_width_px", c.group_width_px}, {"group_height_px", c.group_height_px}}) {
    const std::uint32_t step = group_step_px(c.parts_of_group());
    if (px > 0 && px % step == 0) continue;
    throw InputError(fmt::format(
        "{}: got {}, expected a multiple of {}{}", key, px, step,
        c.parts_of_group() == 1
            ? ""
            : fmt::format(": each of {} HFUs has its part of a group", c.parts_of_group())));
  }
  check(c.rendering);
  const std::uint32_t record_bytes = built_for(c, storage).first_half_bytes;
  if (c.hfu.slice_gaussians * record_bytes % 32 != 0) {
    throw InputError(fmt::format(
        "hfu.slice_gaussians: got {}, {} B each, expected a whole number of 32 B bursts",
        c.hfu.slice_gaussians, record_bytes));
  }
}

}  // namespace sgs
