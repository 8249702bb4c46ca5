// Expansion of operations into steps, each by its routine.
#include "modules/datapath/lane_steps.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace sgs {
namespace {

using Operand = DataFlow::Operand;

constexpr Operand literal(float value) { return {true, __builtin_bit_cast(std::uint32_t, value)}; }

class Expansion {
 public:
  Expansion(const FlowPart& part, const OperationLatencies& latencies)
      : flow_(*part.flow),
        first_(part.first),
        last_(part.last),
        latencies_(latencies),
        product_of_(part.flow->products_of_sums(part.first, part.last)),
        sum_of_(part.last - part.first),
        at_(part.flow->size()) {
    for (std::size_t i = 0; i < product_of_.size(); ++i) {
      if (product_of_[i])
        sum_of_[*product_of_[i] - first_] = static_cast<std::uint32_t>(first_ + i);
    }
    for (std::size_t i = 0; i < part.together.size(); ++i) {
      std::vector<std::uint32_t> asked;
      for (const std::uint32_t node : part.together[i]) {
        const bool asks = node >= first_ && flow_.nodes()[node].operation == Operation::kCompare;
        if (asks) asked.push_back(node);
        if (!asks) comes_with_[node] = static_cast<std::uint32_t>(i + 1);
      }
      asked_.push_back(std::move(asked));
    }
  }

  std::vector<LaneStep> run() {
    for (std::size_t i = first_; i < last_; ++i) {
      const auto node = static_cast<std::uint32_t>(i);
      if (is_wanted(node) && !is_deferred(node)) static_cast<void>(value_of(node));
    }
    // Products that a sum behind `last` takes.
    for (std::size_t i = first_; i < last_; ++i) {
      const auto node = static_cast<std::uint32_t>(i);
      if (is_deferred(node) && !at_[i] && in_a_sum_.count(node) == 0) {
        static_cast<void>(value_of(node));
      }
    }
    for (std::size_t i = 0; i < last_; ++i) {
      const DataFlow::Node& node = flow_.nodes()[i];
      const bool wanted = node.kept || (i >= first_ && node.uses == 0);
      if (!wanted || !at_[i] || at_[i]->is_constant) continue;
      LaneStep& step = steps_[at_[i]->of];
      step.kept = !step.answers;
    }
    return std::move(steps_);
  }

 private:
  // An input that nothing takes is none.
  bool is_wanted(std::uint32_t node) const {
    const DataFlow::Node& of = flow_.nodes()[node];
    return of.operation != Operation::kInput || of.kept;
  }
  // Made when it is known whether the sum that takes it makes it in its own lane.
  bool is_deferred(std::uint32_t node) const {
    return node >= first_ && flow_.is_lone_product({false, node});
  }

  Operand value_of(Operand operand) { return operand.is_constant ? operand : value_of(operand.of); }
  Operand value_of(std::uint32_t node) {
    if (!at_[node]) at_[node] = made(node);
    return *at_[node];
  }

  Operand push(StepBy by, const std::vector<LaneStep::Source>& sources) {
    LaneStep step;
    step.by = by;
    std::uint32_t ready = 0;
    for (const LaneStep::Source& source : sources) {
      step.sources.push_back(source);
      if (!source.value.is_constant) ready = std::max(ready, ready_[source.value.of]);
    }
    ready_.push_back(ready + latency_of(step, latencies_));
    steps_.push_back(std::move(step));
    return {false, static_cast<std::uint32_t>(steps_.size() - 1)};
  }
  Operand product(Operand a, Operand b) { return push(StepBy::kProduct, {{0, a}, {1, b}}); }
  Operand sum(Operand a, Operand b) { return push(StepBy::kLane, {{0, a}, {2, b}}); }
  Operand multiply_add(Operand a, Operand b, Operand c) {
    return push(StepBy::kLane, {{0, a}, {1, b}, {2, c}});
  }
  Operand begun(BesideLane operation, Operand of) {
    steps_[of.of].begins = operation;
    return of;
  }
  Operand look_up(BesideLane operation, Operand of) {
    return begun(operation, push(StepBy::kTable, {{0, of}}));
  }
  Operand compared(BesideLane operation, Operand a) {
    return begun(operation, push(StepBy::kComparator, {{0, a}}));
  }
  Operand compared(BesideLane operation, Operand a, Operand b) {
    return begun(operation, push(StepBy::kComparator, {{0, a}, {1, b}}));
  }
  Operand compared_in_a_row(BesideLane operation, Operand a, std::uint32_t times) {
    a = compared(operation, a);
    for (std::uint32_t i = 1; i < times; ++i) a = compared(BesideLane::kNone, a);
    return a;
  }

  Operand from_outside(std::uint32_t node) {
    const auto at = comes_with_.find(node);
    if (at == comes_with_.end()) return push(StepBy::kOutside, {});
    std::vector<LaneStep::Source> answers;
    for (const std::uint32_t comparison : asked_[at->second - 1]) {
      answers.push_back({0, value_of(comparison)});
    }
    const Operand value = push(StepBy::kOutside, answers);
    steps_.back().comes_with = at->second;
    return value;
  }

  std::uint32_t ready(Operand operand) {
    if (operand.is_constant) return 0;
    const Operand value = value_of(operand);
    return value.is_constant ? 0 : ready_[value.of];
  }

  // A product that more than its sum takes leaves the lane ahead of it.
  Operand multiplied(std::uint32_t number) {
    const DataFlow::Node& node = flow_.nodes()[number];
    const Operand a = value_of(node.a), b = value_of(node.b);
    const std::optional<std::uint32_t>& sum = sum_of_[number - first_];
    if (!sum || is_deferred(number)) return product(a, b);
    const DataFlow::Node& of = flow_.nodes()[*sum];
    const bool is_a = !of.a.is_constant && of.a.of == number;
    const Operand c = value_of(is_a ? of.b : of.a);
    const Operand made = push(StepBy::kProduct, {{0, a}, {1, b}, {2, c}});
    at_[*sum] = push(StepBy::kSum, {{0, made}});
    return made;
  }

  Operand added(std::uint32_t number) {
    const DataFlow::Node& node = flow_.nodes()[number];
    const std::optional<std::uint32_t>& product = product_of_[number - first_];
    if (!product) return sum(value_of(node.a), value_of(node.b));
    if (is_deferred(*product)) return added_in_lane(node);
    value_of(*product);
    return *at_[number];
  }
  // The later of two lone products is made in the sum's own lane.
  Operand added_in_lane(const DataFlow::Node& node) {
    const auto deferred = [&](Operand operand) {
      return !operand.is_constant && is_deferred(operand.of);
    };
    const auto factors_ready = [&](Operand product) {
      const DataFlow::Node& of = flow_.nodes()[product.of];
      return std::max(ready(of.a), ready(of.b));
    };
    const bool a = deferred(node.a), b = deferred(node.b);
    const bool takes_a = a && (!b || factors_ready(node.a) >= factors_ready(node.b));
    const Operand in_lane = takes_a ? node.a : node.b, addend = takes_a ? node.b : node.a;
    const DataFlow::Node& of = flow_.nodes()[in_lane.of];
    in_a_sum_.insert(in_lane.of);
    const Operand x = value_of(of.a), y = value_of(of.b), z = value_of(addend);
    return multiply_add(x, y, z);
  }

  // The reciprocal, of products that are not rounded: r += r (1 - d r), twice; what was taken
  // before `first` comes from outside.
  Operand reciprocal(const DataFlow::Node& node) {
    auto [at, is_new] = reciprocals_.try_emplace(node.first_division);
    if (!is_new) return at->second;
    if (node.first_division < first_) return at->second = push(StepBy::kOutside, {});
    const Operand d = value_of(node.b);
    Operand r = look_up(BesideLane::kSeed, d);
    for (int i = 0; i < 2; ++i) r = multiply_add(r, multiply_add(d, r, literal(1)), r);
    return at->second = r;
  }
  Operand divided(const DataFlow::Node& node) {
    const Operand r = node.b.is_constant ? literal(0) : reciprocal(node);
    const Operand n = value_of(node.a), d = value_of(node.b);
    const Operand q = product(n, r);
    return multiply_add(multiply_add(q, d, n), r, q);
  }
  // g = x y and h = y / 2, which is a matter of its exponent; twice r = 1/2 - g h, g += g r, h += h
  // r.
  Operand root(Operand x) {
    Operand h = look_up(BesideLane::kSeed, x);
    Operand g = product(x, h);
    for (int i = 0; i < 2; ++i) {
      const Operand r = multiply_add(g, h, literal(0.5F));
      g = multiply_add(g, r, g);
      h = multiply_add(h, r, h);
    }
    return multiply_add(multiply_add(g, g, x), h, g);
  }
  // The exponent apart, to float; z / c - 1 = r; log c + k ln2; the cubic in r.
  Operand logarithm(Operand x) {
    const Operand apart = compared(BesideLane::kLogarithm, x);
    const Operand row = look_up(BesideLane::kNone, apart);
    const Operand r = multiply_add(apart, row, literal(-1));
    const Operand log_c = multiply_add(push(StepBy::kLane, {{2, apart}}), literal(0.6931F), row);
    const Operand r2 = product(r, r);
    const Operand high = multiply_add(r, literal(0.3333F), literal(-0.5F));
    return multiply_add(multiply_add(r2, literal(-0.25F), high), r2, sum(log_c, r));
  }
  // The ends of its range; n = x / ln2, rounded; x - n ln2 in two parts; polynomial; 2^n.
  Operand exponential(Operand x) {
    for (const float end : {88.0F, -88.0F}) {
      compared(BesideLane::kComparison, x, literal(end));
      steps_.back().answers = true;
    }
    const Operand n = compared_in_a_row(BesideLane::kRounding, product(x, literal(1.4427F)),
                                        kRoundingComparisons);
    const Operand rest = multiply_add(n, literal(1e-6F), multiply_add(n, literal(0.6931F), x));
    Operand p = multiply_add(rest, literal(0.001F), literal(0.01F));
    for (int i = 0; i < 6; ++i) p = multiply_add(p, rest, literal(static_cast<float>(i)));
    return compared(BesideLane::kScaling, p, n);
  }

  Operand made(std::uint32_t number) {
    const DataFlow::Node& node = flow_.nodes()[number];
    if (number < first_) return from_outside(number);
    switch (node.operation) {
      case Operation::kInput:
        return from_outside(number);
      case Operation::kNegate:
      case Operation::kAbsolute:
      case Operation::kMoveBits:
      case Operation::kMaskBits:
        return value_of(node.a);
      case Operation::kMultiply:
        return multiplied(number);
      case Operation::kAdd:
      case Operation::kSubtract:
        return added(number);
      case Operation::kDivide:
        return divided(node);
      case Operation::kSquareRoot:
        return root(value_of(node.a));
      case Operation::kLogarithm:
        return logarithm(value_of(node.a));
      case Operation::kExponential:
        return exponential(value_of(node.a));
      case Operation::kLookUp:
        return look_up(BesideLane::kLookUp, value_of(node.a));
      case Operation::kSplit:
        return compared_in_a_row(BesideLane::kSplit, value_of(node.a), kSplitComparisons);
      case Operation::kCompare: {
        const Operand a = value_of(node.a), b = value_of(node.b);
        return answer(compared(BesideLane::kComparison, a, b));
      }
      case Operation::kIsFinite:
        return answer(compared(BesideLane::kComparison, value_of(node.a)));
      case Operation::kMinimum:
      case Operation::kMaximum:
        return of_two(BesideLane::kComparison, node);
      case Operation::kScale:
        return of_two(BesideLane::kScaling, node);
      case Operation::kAddIndex:
        return of_two(BesideLane::kAddition, node);
      case Operation::kCeil:
      case Operation::kFloor:
      case Operation::kTruncate:
      case Operation::kRound:
        return compared_in_a_row(BesideLane::kRounding, value_of(node.a), kRoundingComparisons);
      case Operation::kFromIndex:
        return compared_in_a_row(BesideLane::kConversion, value_of(node.a), kConversionComparisons);
    }
    return {};
  }
  Operand of_two(BesideLane operation, const DataFlow::Node& node) {
    const Operand a = value_of(node.a), b = value_of(node.b);
    return compared(operation, a, b);
  }
  Operand answer(Operand of) {
    steps_[of.of].answers = true;
    return of;
  }

  const DataFlow& flow_;
  const std::size_t first_, last_;
  const OperationLatencies latencies_;
  std::map<std::uint32_t, std::uint32_t> comes_with_;
  std::vector<std::vector<std::uint32_t>> asked_;               // [list - 1] comparisons
  const std::vector<std::optional<std::uint32_t>> product_of_;  // [sum - first]
  std::vector<std::optional<std::uint32_t>> sum_of_;            // [product - first]
  std::vector<std::optional<Operand>> at_;                      // [node]: its value
  std::set<std::uint32_t> in_a_sum_;                            // products in the lane of a sum
  std::map<std::uint32_t, Operand> reciprocals_;                // [first division]
  std::vector<LaneStep> steps_;
  std::vector<std::uint32_t> ready_;  // [step], with lanes for all
};

// A sum's path goes through its product, which is then no step of its own.
void go_on(LongestPath& path, const LaneStep& step) {
  const StepBy by = step.by;
  path.reads += by == StepBy::kOutside && !step.sources.empty() ? 1 : 0;
  path.lane += by == StepBy::kLane || by == StepBy::kSum ? 1 : 0;
  path.comparator += by == StepBy::kComparator ? 1 : 0;
  path.look_ups += by == StepBy::kTable ? 1 : 0;
  if (by == StepBy::kProduct) ++path.products;
  if (by == StepBy::kSum && path.products > 0) --path.products;
}

// The longest path among those that begin with a step for which `begins` holds.
template <class Begins>
LongestPath longest_from(const std::vector<LaneStep>& steps, const OperationLatencies& latencies,
                         const Begins& begins) {
  std::vector<std::optional<LongestPath>> paths;  // [step], to its value
  LongestPath longest;
  for (const LaneStep& step : steps) {
    std::optional<LongestPath> path;
    if (begins(step)) path = LongestPath{};
    for (const LaneStep::Source& source : step.sources) {
      if (source.value.is_constant) continue;
      const auto& before = paths[source.value.of];
      if (before && (!path || path->cycles(latencies) < before->cycles(latencies))) path = before;
    }
    if (path) go_on(*path, step);
    if (path && longest.cycles(latencies) < path->cycles(latencies)) longest = *path;
    paths.push_back(path);
  }
  return longest;
}

}  // namespace

std::vector<LaneStep> FlowPart::steps(const OperationLatencies& latencies) const {
  return Expansion(*this, latencies).run();
}

std::uint32_t constants_of(const std::vector<LaneStep>& steps) {
  std::set<std::uint32_t> bits;
  for (const LaneStep& step : steps) {
    for (const LaneStep::Source& source : step.sources) {
      if (source.value.is_constant) bits.insert(source.value.of);
    }
  }
  return static_cast<std::uint32_t>(bits.size());
}

LongestPath longest_path(const std::vector<LaneStep>& steps, const OperationLatencies& latencies) {
  return longest_from(steps, latencies, [](const LaneStep&) { return true; });
}

LongestPath longest_loop(const std::vector<LaneStep>& steps, const OperationLatencies& latencies) {
  return longest_from(steps, latencies, [](const LaneStep& step) { return step.comes_with > 0; });
}

}  // namespace sgs
