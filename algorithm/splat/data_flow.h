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

namespace sgs {

// The operations that a computation can consist of, as the counting scalar records it.
enum class Operation : std::uint8_t {
  kInput,
  kNegate,
  kAbsolute,
  kMultiply,
  kAdd,
  kSubtract,
  kDivide,
  kSquareRoot,
  kLogarithm,
  kExponential,
  kLookUp,  // a row of a table
  kSplit,   // into whole steps and a rest
  kScale,   // by a power of two that is computed
  kCompare,
  kMinimum,
  kMaximum,
  kIsFinite,
  kCeil,
  kFloor,
  kTruncate,
  kRound,
  kFromIndex,  // a whole number becomes a float
  kAddIndex,   // two whole numbers
  kMoveBits,   // a whole number's, by places that are known: wires
  kMaskBits    // a whole number's: set or cleared
};

// How many operations of each class a computation takes. Signs (negation, absolute value)
// and selections are not counted, nor bits of a whole number that are moved or cleared.
struct OperationCounts {
  std::uint32_t multiplies = 0;
  std::uint32_t adds = 0;       // and subtractions
  std::uint32_t fused = 0;      // adds in one step with a product that they take
  std::uint32_t divisions = 0;  // quotients; by a constant power of two they are multiplies
  std::uint32_t divisors = 0;   // different ones among them
  std::uint32_t square_roots = 0;
  std::uint32_t logarithms = 0;
  std::uint32_t exponentials = 0;
  std::uint32_t comparisons = 0;  // also minimum, maximum, test for infinity
  std::uint32_t roundings = 0;    // to a whole number
  std::uint32_t splits = 0;       // into whole steps and the rest
  std::uint32_t scalings = 0;     // by a power of two that is computed: added to the exponent
  std::uint32_t conversions = 0;  // whole numbers to floats
  std::uint32_t index_adds = 0;   // adds of whole numbers
  std::uint32_t look_ups = 0;     // each a row of a table of coefficients
};

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
    std::uint32_t first_division;  // for a division: the first by this divisor
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
  // A product that one operation takes, once, and nothing else.
  bool is_lone_product(Operand operand) const;

  // [node - first]: of a sum among nodes [first, last) the product that it takes in one step with
  // it, if any. A step gives its product and one sum. So the product waits for what is added, which
  // must not wait for the product.
  std::vector<std::optional<std::uint32_t>> products_of_sums(std::size_t first,
                                                             std::size_t last) const;

  // Operations among nodes [first, last).
  OperationCounts counts(std::size_t first, std::size_t last) const;

 private:
  using Key = std::tuple<Operation, bool, std::uint32_t, bool, std::uint32_t>;

  std::uint32_t first_division_by(Operand divisor) const;

  std::vector<Node> nodes_;
  std::map<Key, std::uint32_t> known_;
};

}  // namespace sgs
