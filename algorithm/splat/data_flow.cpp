// Numbering of values, and the tally of a range of them.
#include "algorithm/splat/data_flow.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace sgs {
namespace {

bool is_unary(Operation operation) {
  switch (operation) {
    case Operation::kMultiply:
    case Operation::kAdd:
    case Operation::kSubtract:
    case Operation::kDivide:
    case Operation::kCompare:
    case Operation::kMinimum:
    case Operation::kMaximum:
    case Operation::kScale:
    case Operation::kAddIndex:
    case Operation::kMoveBits:
    case Operation::kMaskBits:
      return false;
    default:
      return true;
  }
}

// A comparator gives less, equal and greater at once.
bool commutes(Operation operation) {
  return operation == Operation::kMultiply || operation == Operation::kAdd ||
         operation == Operation::kCompare || operation == Operation::kAddIndex;
}

// Sums in their order, each to one of its products that has none: to a lone one, since no other
// sum takes that, else to the later one.
class Pairing {
 public:
  Pairing(const std::vector<DataFlow::Node>& nodes, std::size_t first, std::size_t last)
      : nodes_(nodes),
        first_(first),
        product_of_(last - first),
        waits_for_(last - first),
        seen_by_(last - first) {}

  std::vector<std::optional<std::uint32_t>> run() {
    for (std::size_t i = 0; i < product_of_.size(); ++i) {
      const DataFlow::Node& sum = nodes_[first_ + i];
      if (sum.operation != Operation::kAdd && sum.operation != Operation::kSubtract) continue;
      const bool prefers_a = rank(sum.a) > rank(sum.b);
      const DataFlow::Operand better = prefers_a ? sum.a : sum.b, other = prefers_a ? sum.b : sum.a;
      if (!pair(i, better, other)) pair(i, other, better);
    }
    return std::move(product_of_);
  }

 private:
  std::pair<bool, std::uint32_t> rank(DataFlow::Operand operand) const {
    return {!operand.is_constant && nodes_[operand.of].uses == 1, operand.of};
  }
  bool is_inside(DataFlow::Operand operand) const {
    return !operand.is_constant && operand.of >= first_ && operand.of < first_ + waits_for_.size();
  }

  bool pair(std::size_t sum, DataFlow::Operand product, DataFlow::Operand addend) {
    if (!is_inside(product) || nodes_[product.of].operation != Operation::kMultiply) return false;
    std::optional<DataFlow::Operand>& waits_for = waits_for_[product.of - first_];
    ++search_;
    if (waits_for || depends(addend, product.of)) return false;
    waits_for = addend;
    product_of_[sum] = product.of;
    return true;
  }

  // True if `operand` is computed from `node`, or waits for it.
  bool depends(DataFlow::Operand operand, std::uint32_t node) {
    if (!is_inside(operand)) return false;
    if (operand.of == node) return true;
    std::uint32_t& seen_by = seen_by_[operand.of - first_];
    if (seen_by == search_) return false;
    seen_by = search_;
    const DataFlow::Node& of = nodes_[operand.of];
    const std::optional<DataFlow::Operand>& waits_for = waits_for_[operand.of - first_];
    return (waits_for && depends(*waits_for, node)) || depends(of.a, node) || depends(of.b, node);
  }

  const std::vector<DataFlow::Node>& nodes_;
  const std::size_t first_;
  std::vector<std::optional<std::uint32_t>> product_of_;     // [sum]
  std::vector<std::optional<DataFlow::Operand>> waits_for_;  // [product]: what is added to it
  std::vector<std::uint32_t> seen_by_;                       // [node]: the last search
  std::uint32_t search_ = 0;
};

}  // namespace

std::uint32_t DataFlow::input() {
  nodes_.push_back({Operation::kInput, {true, 0}, {true, 0}, 0, 0, false});
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t DataFlow::apply(Operation operation, Operand a, Operand b) {
  if (commutes(operation) && std::pair(b.is_constant, b.of) < std::pair(a.is_constant, a.of)) {
    std::swap(a, b);
  }
  const auto [at, is_new] =
      known_.try_emplace(Key{operation, a.is_constant, a.of, b.is_constant, b.of},
                         static_cast<std::uint32_t>(nodes_.size()));
  if (!is_new) return at->second;
  const std::uint32_t first_division =
      operation == Operation::kDivide ? first_division_by(b) : at->second;
  nodes_.push_back({operation, a, b, 0, first_division, false});
  if (!a.is_constant) ++nodes_[a.of].uses;
  if (!is_unary(operation) && !b.is_constant) ++nodes_[b.of].uses;
  return at->second;
}

std::uint32_t DataFlow::first_division_by(Operand divisor) const {
  const auto at = std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& node) {
    return node.operation == Operation::kDivide && node.b.is_constant == divisor.is_constant &&
           node.b.of == divisor.of;
  });
  return static_cast<std::uint32_t>(at - nodes_.begin());
}

bool DataFlow::is_lone_product(Operand operand) const {
  return !operand.is_constant && nodes_[operand.of].operation == Operation::kMultiply &&
         nodes_[operand.of].uses == 1 && !nodes_[operand.of].kept;
}

std::vector<std::optional<std::uint32_t>> DataFlow::products_of_sums(std::size_t first,
                                                                     std::size_t last) const {
  return Pairing(nodes_, first, last).run();
}

OperationCounts DataFlow::counts(std::size_t first, std::size_t last) const {
  OperationCounts c;
  const auto products = products_of_sums(first, last);
  for (std::size_t i = first; i < last; ++i) {
    const Node& node = nodes_[i];
    switch (node.operation) {
      case Operation::kInput:
      case Operation::kNegate:
      case Operation::kAbsolute:
      case Operation::kMoveBits:
      case Operation::kMaskBits:
        break;
      case Operation::kMultiply:
        ++c.multiplies;
        break;
      case Operation::kAdd:
      case Operation::kSubtract:
        ++c.adds;
        if (products[i - first]) ++c.fused;
        break;
      case Operation::kDivide:
        ++c.divisions;
        // The reciprocal of a constant is a constant.
        if (!node.b.is_constant && node.first_division == i) ++c.divisors;
        break;
      case Operation::kSquareRoot:
        ++c.square_roots;
        break;
      case Operation::kLogarithm:
        ++c.logarithms;
        break;
      case Operation::kExponential:
        ++c.exponentials;
        break;
      case Operation::kLookUp:
        ++c.look_ups;
        break;
      case Operation::kSplit:
        ++c.splits;
        break;
      case Operation::kScale:
        ++c.scalings;
        break;
      case Operation::kCompare:
      case Operation::kMinimum:
      case Operation::kMaximum:
      case Operation::kIsFinite:
        ++c.comparisons;
        break;
      case Operation::kCeil:
      case Operation::kFloor:
      case Operation::kTruncate:
      case Operation::kRound:
        ++c.roundings;
        break;
      case Operation::kFromIndex:
        ++c.conversions;
        break;
      case Operation::kAddIndex:
        ++c.index_adds;
        break;
    }
  }
  return c;
}

}  // namespace sgs
