// Pairing of views, keys and parts.
#include "testbench/streaminggs/report/report_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

template <class Map>
std::set<std::string> keys_of(const Map& a, const Map& b) {
  std::set<std::string> keys;
  for (const Map* map : {&a, &b}) {
    for (const auto& [key, value] : *map) keys.insert(key);
  }
  return keys;
}

void pair_views(const ReportedRun& a, const ReportedRun& b, ReportDiff& diff) {
  std::map<int, std::pair<const ReportedView*, const ReportedView*>> by_number;
  for (const ReportedView& view : a.views) by_number[view.view].first = &view;
  for (const ReportedView& view : b.views) by_number[view.view].second = &view;
  const auto alone = [&](const char* run, auto has_it, auto has_not) {
    std::string numbers;
    for (const auto& [number, pair] : by_number) {
      if (has_it(pair) != nullptr && has_not(pair) == nullptr)
        numbers += fmt::format(" {}", number);
    }
    if (!numbers.empty()) diff.unlike.push_back(fmt::format("views of {} alone:{}", run, numbers));
  };
  const auto in_a = [](const auto& pair) { return pair.first; };
  const auto in_b = [](const auto& pair) { return pair.second; };
  alone("A", in_a, in_b);
  alone("B", in_b, in_a);
  for (const auto& [number, pair] : by_number) {
    if (pair.first != nullptr && pair.second != nullptr) diff.views.push_back(pair);
  }
}

std::string fact_of(const ReportedView& view, const std::string& kind) {
  for (const auto& [name, what] : view.facts) {
    if (name == kind) return what;
  }
  return "";
}

// Adds the facts that differ. A sentence that holds for all views is said once.
void compare_facts(ReportDiff& diff) {
  std::map<std::string, std::string> sentences;  // with the views that they are of
  std::vector<std::string> order;
  for (const auto& [a, b] : diff.views) {
    for (const auto& [kind, what] : a->facts) {
      const std::string other = fact_of(*b, kind);
      if (other.empty() || other == what) continue;
      const std::string sentence = fmt::format("{}: {} | {}", kind, what, other);
      if (sentences.count(sentence) == 0) order.push_back(sentence);
      sentences[sentence] += fmt::format(" {}", a->view);
    }
  }
  for (const std::string& sentence : order) {
    const std::string& views = sentences[sentence];
    const auto count = static_cast<std::size_t>(std::count(views.begin(), views.end(), ' '));
    diff.unlike.push_back(count == diff.views.size() ? sentence
                                                     : fmt::format("view{}: {}", views, sentence));
  }
}

void compare_config(const ReportedRun& a, const ReportedRun& b, ReportDiff& diff) {
  const auto value = [](const ReportedRun& run, const std::string& key) {
    const std::string& told = run.config.at(key);
    const auto used = run.used.find(key);
    const bool partly = used != run.used.end() && used->second != told;
    return told + (run.chosen.count(key) > 0 ? " (chosen)" : "") +
           (partly ? fmt::format(" ({} used)", used->second) : "");
  };
  for (const std::string& key : keys_of(a.config, b.config)) {
    if (b.config.count(key) == 0) {
      diff.keys_of_a.push_back(key);
    } else if (a.config.count(key) == 0) {
      diff.keys_of_b.push_back(key);
    } else if (a.config.at(key) == b.config.at(key)) {
      ++diff.equal_keys;
    } else {
      diff.config.push_back({key, value(a, key), value(b, key)});
    }
  }
}

// Whether both store a scene in the same bytes: then other bytes are another scene.
bool store_alike(const ReportedRun& a, const ReportedRun& b) {
  const auto decides = [](const std::string& key) {
    return key == "machine" || key.rfind("storage.", 0) == 0;
  };
  for (const std::string& key : keys_of(a.config, b.config)) {
    if (!decides(key)) continue;
    const auto in_a = a.config.find(key), in_b = b.config.find(key);
    if (in_a == a.config.end() || in_b == b.config.end()) return false;
    if (in_a->second != in_b->second) return false;
  }
  return true;
}

// Scenes of one name and size may differ all the same.
void compare_images(const ReportedRun& a, const ReportedRun& b, ReportDiff& diff) {
  const std::string &in_a = diff.views[0].first->image_hash,
                    &in_b = diff.views[0].second->image_hash;
  if (in_a.empty() || in_b.empty() || in_a == in_b || !store_alike(a, b)) return;
  diff.unlike.push_back(fmt::format("scene's bytes in DRAM, their hash: {} | {}", in_a, in_b));
}

// Sums over the views, of one run.
ReportedQuantity sum_of(const ReportDiff& diff, Quantity quantity, bool of_a) {
  ReportedQuantity sum;
  for (const auto& [a, b] : diff.views) {
    const ReportedQuantity& of_view = (of_a ? a : b)->of(quantity);
    sum.whole += of_view.whole;
    for (const auto& [name, part] : of_view.parts) {
      sum.parts[name].sum += part.sum;
      sum.parts[name].copies = std::max(sum.parts[name].copies, part.copies);
    }
  }
  return sum;
}

bool is_mean_of_copies(Quantity quantity) {
  return quantity == Quantity::kBusy || quantity == Quantity::kWaits;
}

QuantityChange compare(const ReportDiff& diff, Quantity quantity) {
  const ReportedQuantity a = sum_of(diff, quantity, true), b = sum_of(diff, quantity, false);
  const auto views = static_cast<double>(diff.views.size());
  QuantityChange change;
  change.quantity = quantity;
  change.a = a.whole / views;
  change.b = b.whole / views;
  // Cycles that somebody waits are weighed as those that somebody works: against the frame.
  double whole = change.a;
  if (quantity == Quantity::kWaits) {
    whole = sum_of(diff, Quantity::kBusy, true).whole / views;
  }
  const auto value = [&](const ReportedQuantity& of, const std::string& name) -> ReportedPart {
    const auto found = of.parts.find(name);
    if (found == of.parts.end()) return {};
    const double copies = is_mean_of_copies(quantity) ? found->second.copies : 1;
    return {found->second.sum / copies / views, found->second.copies};
  };
  for (const std::string& name : keys_of(a.parts, b.parts)) {
    const ReportedPart in_a = value(a, name), in_b = value(b, name);
    if (in_a.sum == in_b.sum && in_a.copies == in_b.copies) {
      ++change.equal;
      continue;
    }
    const double of_whole = whole > 0 ? (in_b.sum - in_a.sum) / whole : 0;
    change.parts.push_back({name, in_a.sum, in_b.sum, in_a.copies, in_b.copies, of_whole});
  }
  std::stable_sort(change.parts.begin(), change.parts.end(),
                   [](const PartChange& x, const PartChange& y) {
                     return std::abs(x.of_whole) > std::abs(y.of_whole);
                   });
  return change;
}

}  // namespace

ReportDiff diff_runs(const ReportedRun& a, const ReportedRun& b) {
  if (a.stream != b.stream) {
    throw InputError(
        fmt::format("{} and {}: got frames back to back in {} alone, expected both of simulate "
                    "--stream, or neither",
                    a.path, b.path, a.stream ? "the first" : "the second"));
  }
  ReportDiff diff;
  diff.streams = a.stream;
  pair_views(a, b, diff);
  if (diff.views.empty()) {
    throw InputError(fmt::format("{} and {}: got no view that is in both, expected one or more",
                                 a.path, b.path));
  }
  compare_facts(diff);
  compare_images(a, b, diff);
  compare_config(a, b, diff);
  diff.clocks_differ =
      std::any_of(diff.config.begin(), diff.config.end(),
                  [](const ConfigChange& change) { return change.key == "clock_mhz"; });
  for (std::size_t q = 0; q < kQuantities; ++q) {
    diff.quantities.push_back(compare(diff, static_cast<Quantity>(q)));
  }
  using Pair = std::pair<const ReportedView*, const ReportedView*>;
  const auto all_known = [&](const ReportedView* Pair::*run) {
    return std::all_of(diff.views.begin(), diff.views.end(),
                       [&](const Pair& pair) { return (pair.*run)->memory_known; });
  };
  const bool known_of_a = all_known(&Pair::first), known_of_b = all_known(&Pair::second);
  diff.without_memory = !known_of_a && !known_of_b;
  // Reports of earlier programs do not have area by owner.
  const auto not_told = [&](const QuantityChange& q) {
    return (q.quantity == Quantity::kDieArea && (q.a == 0 || q.b == 0)) ||
           (q.quantity == Quantity::kJoules && known_of_a != known_of_b);
  };
  diff.quantities.erase(std::remove_if(diff.quantities.begin(), diff.quantities.end(), not_told),
                        diff.quantities.end());
  std::stable_sort(diff.quantities.begin() + 1, diff.quantities.end(),
                   [](const QuantityChange& x, const QuantityChange& y) {
                     return std::abs(x.ratio()) > std::abs(y.ratio());
                   });
  return diff;
}

}  // namespace sgs
