// A counter is a member that carries its name, unit and meaning; the unit publishes all of them
// with one line of its data sheet.
//
//   struct Counters : CounterSet {
//     Counter keys{*this, "keys", "keys", "sorted"};
//   } counters_;
//
//   counters_.keys += list.size();  // where it happens
//   sheet.counters(counters_);      // in publish()
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sgs {

class Counter;

// The counters of one unit, in the order of their declaration.
class CounterSet {
 public:
  CounterSet(const CounterSet&) = delete;
  CounterSet& operator=(const CounterSet&) = delete;

  const std::vector<const Counter*>& all() const { return all_; }

 protected:
  CounterSet() = default;
  ~CounterSet() = default;

 private:
  friend class Counter;
  std::vector<const Counter*> all_;
};

// Reads as the number that it is.
class Counter {
 public:
  // name: as in the report. unit: of the value ("cycles", "bytes", "keys").
  Counter(CounterSet& of, const char* name, const char* unit, const char* meaning)
      : name_(name), unit_(unit), meaning_(meaning) {
    of.all_.push_back(this);
  }
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  operator std::uint64_t() const { return value_; }
  Counter& operator=(std::uint64_t value) {
    value_ = value;
    return *this;
  }
  Counter& operator++() {
    ++value_;
    return *this;
  }
  Counter& operator+=(std::uint64_t more) {
    value_ += more;
    return *this;
  }
  void raise_to(std::uint64_t value) { value_ = std::max(value_, value); }

  const char* name() const { return name_; }
  const char* unit() const { return unit_; }
  const char* meaning() const { return meaning_; }

 private:
  std::uint64_t value_ = 0;
  const char *name_, *unit_, *meaning_;
};

}  // namespace sgs
