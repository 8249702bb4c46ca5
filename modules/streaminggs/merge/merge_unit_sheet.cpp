// Data sheet of the merge unit: its on-chip memories, counters and costs.
#include "modules/streaminggs/heap_ledger.h"
#include "modules/streaminggs/merge/merge_unit.h"
#include "modules/streaminggs/spare_parts.h"

namespace sgs {
namespace {

constexpr std::uint32_t kKeyWords = 2;  // words compared: depth and slot
constexpr HeapLedger kHeap{"waiting keys", "merge", kKeyBytes, kKeyWords};

}  // namespace

SramUses MergeUnit::sram_uses(const MergeConfig& config, const BuiltFor& built_for) {
  SramUses uses = kHeap.sram_uses(heap_entries(config, built_for), config.cycles_per_operation);
  add(uses, mask_use(built_for.group), built_for.eyes);
  uses.push_back(outstanding_table(kSharedSram, built_for.memory_port));
  if (config.on_overflow != OnOverflow::kSpill) return uses;
  const SramUse block = sram_use("spill blocks", kSharedSram,
                                 {{config.spill_block_entries, "keys"}, {kKeyBytes, "B"}},
                                 {8 * kKeyBytes}, kOneOfEach);
  const auto bytes = static_cast<std::uint32_t>(block.bytes);
  uses.push_back(sram_use("spilled runs", kSharedSram,
                          {{config.spill_runs, "runs"},
                           {2, "blocks"},
                           {config.spill_block_entries, "keys"},
                           {kKeyBytes, "B"}},
                          {8 * kKeyBytes}, kOneOfEach));
  // The first key of each has left it: depth and slot, which are compared all at once, and the
  // rest.
  constexpr std::uint32_t kFrontBytes = 4 * kKeyWords;
  uses.push_back(sram_use(
      "fronts of runs", kSharedSram, {{config.spill_runs, "runs"}, {kFrontBytes, "B"}},
      {8 * kFrontBytes, SramPorts::kReadAndWrite, config.spill_runs}, {config.spill_runs, 1}));
  constexpr std::uint32_t kRestBytes = kKeyBytes - kFrontBytes;
  uses.push_back(sram_use("rest of fronts", kSharedSram,
                          {{config.spill_runs, "runs"}, {kRestBytes, "B"}}, {8 * kRestBytes},
                          kOneOfEach));
  uses.push_back(block);
  uses.push_back(unanswered_writes("spill writes", kSharedSram, built_for.memory_port, bytes));
  return uses;
}

void MergeUnit::publish_ledger(DataSheet& sheet) {
  kHeap.publish(sheet, heap_entries(config_, built_for_), config_.cycles_per_operation,
                heap_work());
  const double of_mask = built_for_.eyes * mask_comparators(built_for_.group);
  sheet.part("merge", "comparator", of_mask, 1);
  sheet.operations("merge", "comparator", of_mask * static_cast<double>(counters_.due));
  sheet.accesses("finished sub-tiles",
                 built_for_.eyes * mask_bits(built_for_.group) * counters_.due, news(masks));
  if (config_.on_overflow != OnOverflow::kSpill) {
    sheet.port(memory);
    return;
  }
  // The nearest of the runs' fronts, a tournament for each key that is read back.
  const double comparators = double{kKeyWords} * (config_.spill_runs - 1);
  sheet.part("merge", "comparator", comparators, 1);
  sheet.operations("merge", "comparator",
                   comparators * static_cast<double>(counters_.keys_spilled));
  sheet.accesses("fronts of runs", config_.spill_runs * counters_.keys_spilled,
                 counters_.keys_spilled);
  sheet.accesses("rest of fronts", counters_.keys_spilled, counters_.keys_spilled);
  sheet.accesses("spilled runs", counters_.keys_spilled, counters_.keys_spilled);
  sheet.accesses("spill blocks", counters_.keys_spilled, counters_.keys_spilled);
  sheet.port(memory, "spill writes");
}

void MergeUnit::publish(DataSheet& sheet) {
  const HeapWork& heap = heap_work();
  const HeapLevelWork below_root = heap.all_levels();
  sheet.unit(*this);
  sheet.activity(merge_, "merge", "takes keys, releases them in final order");
  sheet.counters(counters_);
  sheet.counter("inserts", "operations", "of the heap", heap.inserts);
  sheet.counter("delete_mins", "operations", "of the heap: released", heap.delete_mins);
  sheet.counter("delete_maxs", "operations", "of the heap: spilled", heap.delete_maxs);
  sheet.counter("heap_nodes_read", "nodes", "of two keys and two counts, below the root",
                below_root.nodes_read);
  sheet.counter("heap_nodes_read_ahead", "nodes",
                "beside these where the heap reads ahead: below keys that did not rise",
                below_root.nodes_read_ahead);
  sheet.counter("heap_nodes_written", "nodes", "below the root", below_root.nodes_written);
  sheet.counter("heap_comparisons", "comparisons", "of two keys", heap.comparisons);
  publish_ledger(sheet);
  constexpr std::uint64_t kFewestEntries = 2;
  publish_spare(sheet, "spare_merge_entries", "merge.entries", config_.entries,
                counters_.pending_keys_max, kFewestEntries);
  sheet.left_out("hidden_gaussians", "all sub-tiles that they reach were finished",
                 counters_.dropped_hidden, "second halves and fine filtering");
  sheet.left_out("saturated_gaussians", "the group finished while its visits were under way",
                 counters_.dropped_saturated, "filtering and second halves");
  sheet.sram(sram_uses(config_, built_for_));
  if (config_.cycles_per_operation > kFewestHeapCycles) {
    sheet.remedy(merge_, {"merge.cycles_per_operation", Turn::kDown});
  }
  sheet.remedy(memory, WaitFor::kReads, "merge.entries");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.signal("group", group_);
  sheet.level("pending", "keys", pending_count_);
}

}  // namespace sgs
