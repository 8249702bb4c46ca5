// A float that records in a DataFlow every operation it goes through. The templates of
// algorithm/splat instantiated with it compute what they compute with float, and count it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <type_traits>

#include "algorithm/splat/data_flow.h"
#include "algorithm/splat/exp2.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

// A whole number in the graph. Sums and comparisons are operations; products, quotients and masks
// with a constant power of two are wires.
struct CountingIndex {
  int value;
  DataFlow* flow;  // null: a constant
  std::uint32_t node;

  CountingIndex() = default;
  CountingIndex(int constant) : value(constant), flow(nullptr), node(0) {}  // NOLINT: as an int
  CountingIndex(int result, DataFlow* in, std::uint32_t at) : value(result), flow(in), node(at) {}
};

struct Counting {
  float value;
  DataFlow* flow;      // null: a constant
  std::uint32_t node;  // in the flow

  Counting() = default;  // trivial, as glm wants it
  explicit Counting(float constant) : value(constant), flow(nullptr), node(0) {}
  Counting(float result, DataFlow* in, std::uint32_t at) : value(result), flow(in), node(at) {}

  explicit operator CountingIndex() const;  // toward zero
  explicit operator double() const { return static_cast<double>(value); }
};

inline float value_of(Counting a) { return a.value; }
inline int value_of(CountingIndex a) { return a.value; }

inline Counting input(DataFlow& flow, float value) { return {value, &flow, flow.input()}; }

inline glm::vec<3, Counting> input(DataFlow& flow, const glm::vec3& v) {
  return {input(flow, v.x), input(flow, v.y), input(flow, v.z)};
}
inline CountingIndex input_index(DataFlow& flow, int value) { return {value, &flow, flow.input()}; }

// Marks the values that the computation hands on at its end.
template <class Value>
void keep(DataFlow& flow, std::initializer_list<Value> values) {
  for (const Value& value : values) {
    if (value.flow != nullptr) flow.keep(value.node);
  }
}

inline DataFlow::Operand operand_of(Counting a) {
  if (a.flow != nullptr) return {false, a.node};
  return {true, __builtin_bit_cast(std::uint32_t, a.value)};
}

inline DataFlow::Operand operand_of(CountingIndex a) {
  if (a.flow != nullptr) return {false, a.node};
  return {true, static_cast<std::uint32_t>(a.value)};
}

// Result: Counting or CountingIndex, as the value is a float or an int.
template <class Value, class A, class B>
auto recorded(Value result, Operation operation, A a, B b) {
  using Result = std::conditional_t<std::is_same_v<Value, float>, Counting, CountingIndex>;
  DataFlow* const flow = a.flow != nullptr ? a.flow : b.flow;
  if (flow == nullptr) return Result(result);
  return Result(result, flow, flow->apply(operation, operand_of(a), operand_of(b)));
}
template <class Value, class A>
auto recorded(Value result, Operation operation, A a) {
  return recorded(result, operation, a, a);
}

inline Counting operator-(Counting a) { return recorded(-a.value, Operation::kNegate, a); }
inline Counting operator+(Counting a, Counting b) {
  return recorded(a.value + b.value, Operation::kAdd, a, b);
}
inline Counting operator-(Counting a, Counting b) {
  return recorded(a.value - b.value, Operation::kSubtract, a, b);
}
inline Counting operator*(Counting a, Counting b) {
  return recorded(a.value * b.value, Operation::kMultiply, a, b);
}
// The reciprocal of a power of two is exact: the product is the quotient.
inline Counting operator/(Counting a, Counting b) {
  int exponent = 0;
  const bool by_power_of_two = b.flow == nullptr && std::frexp(b.value, &exponent) == 0.5F;
  if (by_power_of_two) return a * Counting(1 / b.value);
  return recorded(a.value / b.value, Operation::kDivide, a, b);
}

inline Counting sqrt(Counting a) { return recorded(std::sqrt(a.value), Operation::kSquareRoot, a); }
inline Counting log(Counting a) { return recorded(std::log(a.value), Operation::kLogarithm, a); }
inline Counting exp(Counting a) { return recorded(exp_of(a.value), Operation::kExponential, a); }
inline Counting abs(Counting a) { return recorded(std::abs(a.value), Operation::kAbsolute, a); }
inline Counting ceil(Counting a) { return recorded(std::ceil(a.value), Operation::kCeil, a); }
inline Counting floor(Counting a) { return recorded(std::floor(a.value), Operation::kFloor, a); }
inline Counting round(Counting a) { return recorded(std::round(a.value), Operation::kRound, a); }
inline Counting::operator CountingIndex() const {
  return recorded(static_cast<int>(value), Operation::kTruncate, *this);
}

template <>
struct WholeNumbers<Counting> {
  using Index = CountingIndex;
  using Short = CountingIndex;
};
template <>
inline Counting number_of<Counting>(CountingIndex index) {
  return recorded(static_cast<float>(index.value), Operation::kFromIndex, index);
}
inline CountingIndex operator+(CountingIndex a, CountingIndex b) {
  return recorded(a.value + b.value, Operation::kAddIndex, a, b);
}
inline CountingIndex operator-(CountingIndex a, int constant) { return a + -constant; }
inline CountingIndex operator*(CountingIndex a, int power_of_two) {
  return recorded(a.value * power_of_two, Operation::kMoveBits, a, CountingIndex(power_of_two));
}
inline CountingIndex operator/(CountingIndex a, int power_of_two) {
  return recorded(a.value / power_of_two, Operation::kMoveBits, a, CountingIndex(-power_of_two));
}
inline CountingIndex without_bits(CountingIndex a, int bits) {
  return recorded(a.value & ~bits, Operation::kMaskBits, a, CountingIndex(~bits));
}
inline CountingIndex with_bits(CountingIndex a, int bits) {
  return recorded(a.value | bits, Operation::kMaskBits, a, CountingIndex(bits));
}
inline bool operator<(CountingIndex a, CountingIndex b) {
  recorded(0, Operation::kCompare, a, b);
  return a.value < b.value;
}
inline bool operator<=(CountingIndex a, CountingIndex b) {
  recorded(0, Operation::kCompare, a, b);
  return a.value <= b.value;
}
template <>
inline CountingIndex max_of<CountingIndex>(CountingIndex a, CountingIndex b) {
  return recorded(max_of(a.value, b.value), Operation::kMaximum, a, b);
}
template <>
inline CountingIndex min_of<CountingIndex>(CountingIndex a, CountingIndex b) {
  return recorded(min_of(a.value, b.value), Operation::kMinimum, a, b);
}

inline bool isfinite(Counting a) {
  recorded(a.value, Operation::kIsFinite, a);
  return std::isfinite(a.value);
}
inline bool operator<(Counting a, Counting b) {
  recorded(0, Operation::kCompare, a, b);
  return a.value < b.value;
}
inline bool operator>(Counting a, Counting b) { return b < a; }
inline bool operator<=(Counting a, Counting b) {
  recorded(0, Operation::kCompare, a, b);
  return a.value <= b.value;
}
inline bool operator>=(Counting a, Counting b) { return b <= a; }

// The result is a value of its own, whichever operand it is.
template <>
inline Counting max_of<Counting>(Counting a, Counting b) {
  return recorded(max_of(a.value, b.value), Operation::kMaximum, a, b);
}
template <>
inline Counting min_of<Counting>(Counting a, Counting b) {
  return recorded(min_of(a.value, b.value), Operation::kMinimum, a, b);
}

// The steps of exp2_by_table(). A look-up gives the whole row: all its columns are one node.
inline Exp2Parts<Counting> exp2_parts(Counting t) {
  const Exp2Parts<float> parts = exp2_parts(t.value);
  return {recorded(parts.rest, Operation::kSplit, t), parts.steps};
}
inline Counting row_entry(Counting rest, float value) {
  if (rest.flow == nullptr) return Counting(value);
  return recorded(value, Operation::kLookUp, rest);
}
template <>
inline Counting exp2_coefficient(const Exp2Parts<Counting>& parts, std::size_t column) {
  return row_entry(parts.rest,
                   exp2_coefficient(Exp2Parts<float>{parts.rest.value, parts.steps}, column));
}
inline Counting scaled_by_steps(Counting x, std::int32_t steps) {
  return recorded(scaled_by_steps(x.value, steps), Operation::kScale, x,
                  Counting(static_cast<float>(steps)));
}
inline Counting scaled_by(Counting x, float power_of_two) {
  return recorded(x.value * power_of_two, Operation::kScale, x, Counting(power_of_two));
}
inline Counting inverse_root_above(Counting x) {
  return recorded(inverse_root_above(x.value), Operation::kLookUp, x);
}
inline Counting moved_by_units(Counting x, CountingIndex units) {
  return recorded(moved_by_units(x.value, units.value), Operation::kAddIndex, x, units);
}
template <>
inline Counting exp2_of<Counting>(Counting t) {
  return exp2_by_table(t);
}

// A half (half_scalar.h) that records every operation it goes through: the templates of blending
// instantiated with it round as HalfScalar does, and are counted. Rounding to 16 bits is part of
// the operation that it follows; an addition to an exponent rounds in the same adder.
class CountingHalf {
 public:
  CountingHalf() = default;
  explicit CountingHalf(float constant) : half_(rounded_to_half(constant)) {}
  explicit CountingHalf(Counting x) : half_(x) { half_.value = rounded_to_half(x.value); }
  Counting counting() const { return half_; }

  friend CountingHalf operator-(CountingHalf a) { return CountingHalf(-a.half_); }
  friend CountingHalf operator+(CountingHalf a, CountingHalf b) {
    return CountingHalf(a.half_ + b.half_);
  }
  friend CountingHalf operator-(CountingHalf a, CountingHalf b) {
    return CountingHalf(a.half_ - b.half_);
  }
  friend CountingHalf operator*(CountingHalf a, CountingHalf b) {
    return CountingHalf(a.half_ * b.half_);
  }
  friend bool operator<(CountingHalf a, CountingHalf b) { return a.half_ < b.half_; }
  friend bool operator>(CountingHalf a, CountingHalf b) { return a.half_ > b.half_; }
  friend bool operator>=(CountingHalf a, CountingHalf b) { return a.half_ >= b.half_; }

 private:
  Counting half_;
};

inline float value_of(CountingHalf a) { return a.counting().value; }

template <>
inline CountingHalf max_of<CountingHalf>(CountingHalf a, CountingHalf b) {
  return CountingHalf(max_of(a.counting(), b.counting()));
}
template <>
inline CountingHalf min_of<CountingHalf>(CountingHalf a, CountingHalf b) {
  return CountingHalf(min_of(a.counting(), b.counting()));
}

template <>
inline CountingHalf narrowed<CountingHalf, Counting>(Counting x) {
  return CountingHalf(recorded(clamped_to_half(x.value), Operation::kRound, x));
}

template <>
struct Exp2TableOf<CountingHalf> : Exp2TableOf<HalfScalar> {};

inline Exp2Parts<CountingHalf> exp2_parts(CountingHalf t) {
  const Exp2Parts<Counting> parts = exp2_parts(t.counting());
  return {CountingHalf(parts.rest), parts.steps};
}
template <>
inline CountingHalf exp2_coefficient(const Exp2Parts<CountingHalf>& parts, std::size_t column) {
  const auto value = Exp2TableOf<HalfScalar>::kTable.column[column][exp2_row(parts.steps)];
  return CountingHalf(row_entry(parts.rest.counting(), value));
}
inline CountingHalf scaled_by_steps(CountingHalf x, std::int32_t steps) {
  return CountingHalf(scaled_by_steps(x.counting(), steps));
}
template <>
inline CountingHalf exp2_of<CountingHalf>(CountingHalf t) {
  return exp2_by_table(t);
}

}  // namespace sgs
