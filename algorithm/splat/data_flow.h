// The operations of one computation as a graph: what is computed from what.
// An operation on the same operands as an earlier one is the earlier one, as it would be in a
// datapath or behind a compiler. Operations on constants alone are made beforehand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "algorithm/splat/longest_path.h"
#include "algorithm/splat/operation_counts.h"

namespace sgs {

class DataFlow {
 public:
  // A constant's bits, or the number of a node.
  struct Operand {
    bool is_constant;
    std::uint32_t of;
  };

  struct Node {
    Operation operation;
    Operand a, b;
    std::uint32_t uses;            // operations that take it, twice where they take it twice
    std::uint32_t first_division;  // of a division: the first by this divisor
    bool kept;
  };

  // A new value that comes from outside; its node.
  std::uint32_t input();

  // The node that holds the result; operations of one operand have it twice.
  std::uint32_t apply(Operation operation, Operand a, Operand b);

  // The value is wanted at the end of the computation, whatever takes it meanwhile. One that
  // nothing takes is wanted then in any case.
  void keep(std::uint32_t node) { nodes_[node].kept = true; }
  // So many words that nothing computes with go along with an item to its end.
  void pass_beside(std::size_t words) {
    for (std::size_t i = 0; i < words; ++i) keep(input());
  }

  std::size_t size() const { return nodes_.size(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  // A product that one operation takes, once.
  bool is_lone_product(Operand operand) const;

  // Operations among nodes [first, last). A sum fuses with a product only if nothing in the whole
  // graph takes the product a second time.
  OperationCounts counts(std::size_t first, std::size_t last) const;

  // The operations that wait for each other among nodes [first, last), longest in cycles. What
  // comes from outside or lies before `first` is there at the beginning.
  LongestPath longest_path(std::size_t first, std::size_t last,
                           const OperationLatencies& latencies) const;
  // The same from one of these nodes on: everything that depends on none of them is there.
  LongestPath longest_path_from(const std::vector<std::uint32_t>& sources,
                                const OperationLatencies& latencies) const;
  // [node] when its value is there, in cycles, if all that comes from outside is there at 0.
  std::vector<std::uint32_t> ready_cycles(const OperationLatencies& latencies) const;

 private:
  using Key = std::tuple<Operation, bool, std::uint32_t, bool, std::uint32_t>;

  // The path to each value, none to what is there at the beginning; null: it is on no path.
  using Paths = std::vector<std::optional<LongestPath>>;

  std::optional<LongestPath> path_through(const Node& node, std::size_t first, const Paths& paths,
                                          const OperationLatencies& latencies) const;
  Paths extended(Paths paths, std::size_t first, std::size_t last,
                 const OperationLatencies& latencies) const;
  LongestPath longest_of(const Paths& paths, std::size_t last,
                         const OperationLatencies& latencies) const;
  std::uint32_t first_division_by(Operand divisor) const;

  std::vector<Node> nodes_;
  std::map<Key, std::uint32_t> known_;
};

}  // namespace sgs
