// Arithmetic of the on-chip memory, and the group that it holds.
#include "modules/streaminggs/streaming_sram.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/render/group_shape.h"
#include "modules/memory_too_small.h"
#include "modules/streaminggs/hfu/hfu.h"
#include "modules/streaminggs/rendering/rendering_unit.h"

namespace sgs {

namespace {

// Every Gaussian that lies on a border between groups is fetched for both: the shorter the borders
// the fewer bytes, as long as a group's pixels fit beside what waits.
void choose_group(StreamingConfig& config, std::vector<PixelSize> frames,
                  const std::function<SramUses()>& uses, std::vector<AutoChoice>& chosen) {
  constexpr PixelSize kAnyFrame = square_of(65536);  // so wide that groups need not divide it
  if (frames.empty()) frames.push_back(kAnyFrame);
  const auto step = static_cast<int>(group_step_px(config.parts_of_group()));
  const auto needed = [&](const PixelSize& group) {
    config.set_group(group);
    return sram_bytes(uses(), kSharedSram);
  };
  const PixelSize best = group_for_frame(frames, step, kMaxGroupPx, [&](const PixelSize& group) {
    return needed(group) <= config.sram.shared_bytes;
  });
  if (best == PixelSize{}) {
    throw InputError(
        fmt::format("group_width_px: not even a group of {} px x {} px fits sram.shared_bytes {}",
                    step, step, config.sram.shared_bytes));
  }
  const std::string why = fmt::format(
      "{} px x {} px have the shortest borders of those groups whose pixels fit: {} of {} B are "
      "used",
      best.width, best.height, needed(best), config.sram.shared_bytes);
  constexpr ChoiceKind kKind = ChoiceKind::kDecided;
  chosen.push_back({kKind, "group_width_px", static_cast<double>(best.width), why});
  chosen.push_back({kKind, "group_height_px", static_cast<double>(best.height), why});
}

// One memory: sized where it is left open, checked where it is given.
void size(const char* key, std::uint32_t& bytes, const SramUses& uses, const std::string& memory,
          std::vector<AutoChoice>& chosen) {
  if (bytes == 0) {
    bytes = static_cast<std::uint32_t>(sram_bytes(uses, memory));
    chosen.push_back(
        {ChoiceKind::kDerived, key, static_cast<double>(bytes), sram_sum(uses, memory)});
  }
  check_sram<MemoryTooSmall>(key, bytes, uses, memory, ", or 0 for as many as that");
}

}  // namespace

std::vector<const char*> SramPlan::fit() {
  fitted = true;
  return {"sram.input_bytes", "sram.shared_bytes"};
}

FifoKind<VisitShare> visit_fifos(const StreamingConfig& c) {
  return {"visits", "visits", c.fetches(), kVisitFifoEntries, 1};
}

SramUses streaming_sram_uses(const StreamingConfig& c, const BuiltFor& built_for) {
  SramUses uses;
  add(uses, RenderingUnit::sram_uses(rendering_of_part(c), built_for_part(c, built_for)),
      c.parts());
  add(uses, Hfu::sram_uses(c.hfu, built_for, c.parts()), c.fetches());
  add(uses, visit_fifos(c).all());
  // The codebook buffer's: where there is one.
  if (built_for.second_half.quantised()) {
    add(uses, outstanding_table(kSharedSram, built_for.memory_port));
  }
  return uses;
}

void resolve_sram(StreamingConfig& config, const StorageConfig& storage, const SramPlan& plan,
                  const std::function<SramUses()>& uses, std::vector<AutoChoice>& chosen) {
  if ((config.group_width_px == 0) != (config.group_height_px == 0)) {
    throw InputError(fmt::format(
        "group_width_px: got {} with group_height_px {}, expected both 0 or neither: a group is "
        "chosen as a whole",
        config.group_width_px, config.group_height_px));
  }
  if (config.group_open()) {
    if (config.sram.shared_bytes == 0) {
      throw InputError(
          "group_width_px: got 0 with sram.shared_bytes 0, expected one of them: each is chosen "
          "by the other");
    }
    choose_group(config, plan.frames, uses, chosen);
  }
  if (plan.fitted) config.sram.input_bytes = config.sram.shared_bytes = 0;
  check(config, storage);
  const SramUses all = uses();
  size("sram.input_bytes", config.sram.input_bytes, all, kInputSram, chosen);
  size("sram.shared_bytes", config.sram.shared_bytes, all, kSharedSram, chosen);
}

}  // namespace sgs
