// Arithmetic of the on-chip memory, and the largest group that it holds.
#include "modules/streaminggs/streaming_sram.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "modules/streaminggs/hfu/hfu.h"
#include "modules/streaminggs/rendering/rendering_unit.h"

namespace sgs {

namespace {

// Every Gaussian that crosses a border between groups is fetched for both: the larger the group the
// fewer bytes, as long as its pixels fit beside what waits.
AutoChoice choose_group(StreamingConfig& config, const std::function<SramUses()>& uses) {
  constexpr std::uint32_t kStepPx = 16, kMostPx = 512;
  std::uint32_t largest = 0;
  std::uint64_t bytes = 0;
  for (config.group_px = kStepPx; config.group_px <= kMostPx; config.group_px += kStepPx) {
    const std::uint64_t needed = sram_bytes(uses(), kSharedSram);
    if (needed > config.sram.shared_bytes) break;
    largest = config.group_px;
    bytes = needed;
  }
  if (largest == 0) {
    throw InputError(fmt::format("group_px: not even a group of {} px fits sram.shared_bytes {}",
                                 kStepPx, config.sram.shared_bytes));
  }
  config.group_px = largest;
  return {"group_px", static_cast<double>(largest),
          fmt::format("the largest group, in steps of {} px, whose pixels fit: {} of {} B are used",
                      kStepPx, bytes, config.sram.shared_bytes)};
}

// One memory: sized where it is left open, checked where it is given.
void size(const char* key, std::uint32_t& bytes, const SramUses& uses, const std::string& memory,
          std::vector<AutoChoice>& chosen) {
  if (bytes == 0) {
    bytes = static_cast<std::uint32_t>(sram_bytes(uses, memory));
    chosen.push_back({key, static_cast<double>(bytes), sram_sum(uses, memory)});
  }
  check_sram(key, bytes, uses, memory);
}

}  // namespace

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

void check_sram(const char* key, std::uint64_t available, const SramUses& uses,
                const std::string& memory) {
  const std::uint64_t needed = sram_bytes(uses, memory);
  if (needed <= available) return;
  throw InputError(fmt::format("{}: {} bytes are there, {} are needed: {}", key, available, needed,
                               sram_sum(uses, memory)));
}

void resolve_sram(StreamingConfig& config, const StorageConfig& storage,
                  const std::function<SramUses()>& uses, std::vector<AutoChoice>& chosen) {
  if (config.group_px == 0 && config.sram.shared_bytes == 0) {
    throw InputError(
        "group_px: got 0 with sram.shared_bytes 0, expected one of them: each is chosen "
        "by the other");
  }
  if (config.group_px == 0) chosen.push_back(choose_group(config, uses));
  check(config, storage);
  const SramUses all = uses();
  size("sram.input_bytes", config.sram.input_bytes, all, kInputSram, chosen);
  size("sram.shared_bytes", config.sram.shared_bytes, all, kSharedSram, chosen);
}

}  // namespace sgs
