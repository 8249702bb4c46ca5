// Numbering of values, and the tally of a range of them.
#include "algorithm/splat/data_flow.h"

#include <algorithm>
#include <utility>

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
         nodes_[operand.of].uses == 1;
}

OperationCounts DataFlow::counts(std::size_t first, std::size_t last) const {
  OperationCounts c;
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
        if (is_lone_product(node.a) || is_lone_product(node.b)) ++c.fused;
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
