// Data sheet of the fine filter: its on-chip memory, counters and costs.
#include <algorithm>

#include "modules/streaminggs/hfu/filter_datapaths.h"
#include "modules/streaminggs/hfu/fine_filter.h"

namespace sgs {
namespace {

// Word of the slots for second halves: as wide as the port, or as a record that is narrower.
SramShape word_of(std::uint32_t record_bytes) {
  return {8 * std::clamp(record_bytes, 1U, kPortBytes)};
}

}  // namespace

std::uint32_t FineFilter::read_cycles(std::uint32_t record_bytes) {
  return static_cast<std::uint32_t>(sram_words(record_bytes, word_of(record_bytes)));
}

SramUses FineFilter::sram_uses(const HfuConfig& config, const BuiltFor& built_for,
                               std::uint32_t parts) {
  // A part's reads do not wait for another's: as many banks, while there are words for them.
  const SramShape word = word_of(built_for.second_half_bytes);
  const auto words = static_cast<std::uint32_t>(config.second_half_slots *
                                                sram_words(built_for.second_half_bytes, word));
  const std::uint32_t banks = std::clamp(words, 1U, parts);
  SramUses uses = {
      sram_use("second halves", kSharedSram,
               {{config.second_half_slots, "slots"}, {built_for.second_half_bytes, "B"}},
               {word.width_bits, word.ports, banks}, {banks, 1}),
      outstanding_table(kSharedSram, built_for.memory_port)};
  add(uses,
      fifo_use<FineCandidate>("fetched candidates", kSharedSram, fetched_entries(config),
                              "candidates"),
      parts);
  if (built_for.second_half.quantised()) {
    add(uses, fifo_use<Decoded>("decoded Gaussians", kSharedSram, kDecodedEntries, "entries"),
        parts);
  }
  return uses;
}

// A slot is held until the last part has taken what is in it: that is the busiest, mostly.
void FineFilter::name_holder_of_slots() {
  for (const auto& part : parts_) part->taker().close();
  const auto busiest = std::max_element(parts_.begin(), parts_.end(), [](auto& a, auto& b) {
    return a->taker().busy_cycles() < b->taker().busy_cycles();
  });
  free_slots_.name_writer((*busiest)->taker());
}

void FineFilter::publish(DataSheet& sheet) {
  name_holder_of_slots();
  sheet.unit(*this);
  sheet.activity(fetch_, "fetch", "asks for second halves");
  for (const auto& part : parts_) {
    if (part->stage) sheet.activity(part->stage->decode, "decode", "reads their codebook entries");
    sheet.activity(part->filter, "fine", "puts them through the FFU");
  }
  sheet.counters(counters_);
  sheet.datapath(tests_, counters_.fine_tests);
  if (built_for_.splats == NumberFormat::kHalf) {
    sheet.datapath(side_by_side(rounding_pipeline(config_, built_for_.single),
                                static_cast<std::uint32_t>(parts_.size())),
                   counters_.splats);
  }
  const std::uint64_t words = read_cycles(record_bytes_);
  sheet.accesses("second halves", counters_.second_halves_taken * words,
                 counters_.second_halves * words);
  sheet.left_out("saturated_gaussians", "the group finished while its visits were under way",
                 counters_.dropped_saturated - counters_.dropped_fetched,
                 "filtering and second halves");
  sheet.left_out("saturated_tests", "the group finished while second halves were under way",
                 counters_.dropped_fetched, "the fine test: second halves were fetched");
  sheet.port(memory);
  sheet.sram(sram_uses(config_, built_for_, static_cast<std::uint32_t>(parts_.size())));
  for (const auto& part : parts_) {
    part->numbers.publish(sheet, "fine");
    sheet.queue(part->fetched, "fetched candidates");
    sheet.remedy(part->filter, "hfu.ffu_lanes");
    sheet.may_help("hfu.ffus");
    sheet.remedy(part->fetched, WaitFor::kRoom, "hfu.second_half_slots");
    if (!part->stage) continue;
    sheet.queue(part->stage->decoded, "decoded Gaussians");
    sheet.remedy(part->stage->decode, "codebook.line_bytes");
  }
  sheet.remedy(memory, WaitFor::kReads, "hfu.second_half_slots");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(free_slots_, WaitFor::kRoom, "hfu.second_half_slots");
}

}  // namespace sgs
