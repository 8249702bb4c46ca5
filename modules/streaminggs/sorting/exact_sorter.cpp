// The thread of a sorting unit in exact order.
#include "modules/streaminggs/sorting/exact_sorter.h"

#include <algorithm>
#include <vector>

#include "modules/streaminggs/nearer_key.h"
#include "modules/streaminggs/sorting/sorting_cost.h"

namespace sgs {
namespace {
constexpr const char* kKeySorters = "key sorters";
}  // namespace

ExactSorter::ExactSorter(const sc_core::sc_module_name& name, const SortingNetworkConfig& config,
                         std::uint32_t first_visit, std::uint32_t visit_step,
                         const UnitContext& context)
    : sc_module(name),
      config_(config),
      built_for_(context.built_for),
      visit_step_(visit_step),
      sort_("sort", context.clock),
      visit_(first_visit) {
  SC_THREAD(run);
}

void ExactSorter::run() {
  std::vector<FineCandidate> list;
  for (;; visit_ += visit_step_) {
    list.clear();
    FifoReadIf<FineCandidate>& input = in_turn(keys, visit_);
    FineCandidate key = input.pop(sort_);
    sort_.takes_up_group(key.group, visit_);
    while (key.mark == Mark::kNone) {
      sort_.work(1);
      list.push_back(key);
      key = input.pop(sort_);
    }
    std::sort(list.begin(), list.end(), NearerKey{});
    const SortingCost cost = sort_cost(config_, list.size());
    sort_.work(cost.cycles);
    ++counters_.visits;
    counters_.visits_trivial += list.size() == 1 ? 1 : 0;
    counters_.keys += list.size();
    counters_.compare_exchanges += cost.compare_exchanges;
    counters_.moves += cost.moves;
    for (const FineCandidate& next : list) {
      sort_.work(1);
      sorted->push(next, sort_);
    }
    sort_.work(1);
    sorted->push(key, sort_);
  }
}

SramUses ExactSorter::sram_uses(const BuiltFor& built_for) {
  return sort_memories(kKeySorters, kSharedSram, built_for.chunk_gaussians, kKeyBytes);
}

void ExactSorter::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(sort_, "sorting", "takes, sorts and hands on the keys of one chunk");
  sheet.counters(counters_);
  publish_network(sheet, config_, built_for_.chunk_gaussians, counters_.compare_exchanges,
                  counters_.moves);
  publish_trivial_sorts(sheet, config_, counters_.visits_trivial);
  sheet.sram(sram_uses(built_for_));
  publish_sort_accesses(sheet, kKeySorters, counters_.keys, counters_.moves);
  sheet.remedy(sort_, "sorting_units");
  sheet.signal("visit", visit_);
}

}  // namespace sgs
