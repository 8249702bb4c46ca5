// One description of a configuration serves reading, writing and listing it.
//
//   void visit(ConfigVisitor& v, DramConfig& c) {
//     v("channels", c.channels, in_range(1, 16), "independent channels");
//     v("page_policy", c.page_policy, names({{"open", PagePolicy::kOpen}, ...}), "when rows
//     close"); v.section("power", c.power, "idle states");   // calls visit(v, c.power)
//   }
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace sgs {

// Closed interval of the values that a number may take. long double holds every 64-bit integer
// exactly.
struct ConfigRange {
  long double lo;
  long double hi;
};

template <class A, class B>
ConfigRange in_range(A lo, B hi) {
  return {static_cast<long double>(lo), static_cast<long double>(hi)};
}
inline ConfigRange at_least(long double lo) {
  return {lo, static_cast<long double>(std::numeric_limits<std::int64_t>::max())};
}

template <class Enum>
using ConfigNames = std::vector<std::pair<const char*, Enum>>;
template <class Enum>
ConfigNames<Enum> names(std::initializer_list<std::pair<const char*, Enum>> list) {
  return list;
}

class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;

  void operator()(const char* key, bool& value, const char* doc) { on_bool(key, value, doc); }
  void operator()(const char* key, std::string& value, const char* doc) {
    on_string(key, value, doc);
  }
  void operator()(const char* key, double& value, ConfigRange range, const char* doc) {
    on_real(key, value, range, doc);
  }
  // A number that may be left open: null in JSON.
  void operator()(const char* key, std::optional<double>& value, ConfigRange range,
                  const char* doc) {
    on_open_real(key, value, range, doc);
  }
  void operator()(const char* key, std::vector<double>& value, ConfigRange range, const char* doc) {
    on_reals(key, value, range, doc);
  }

  // Integers of any width; the range is cut to what the type holds.
  template <class Int, std::enable_if_t<std::is_integral_v<Int>, int> = 0>
  void operator()(const char* key, Int& value, ConfigRange range, const char* doc) {
    const ConfigRange type =
        in_range(std::numeric_limits<Int>::min(),
                 std::min<std::uintmax_t>(std::numeric_limits<Int>::max(), INT64_MAX));
    auto wide = static_cast<std::int64_t>(value);
    on_integer(key, wide, {std::max(range.lo, type.lo), std::min(range.hi, type.hi)}, doc);
    value = static_cast<Int>(wide);
  }

  template <class Enum, std::enable_if_t<std::is_enum_v<Enum>, int> = 0>
  void operator()(const char* key, Enum& value, const ConfigNames<Enum>& allowed, const char* doc) {
    std::vector<const char*> texts;
    std::size_t index = 0;
    for (std::size_t i = 0; i < allowed.size(); ++i) {
      texts.push_back(allowed[i].first);
      if (allowed[i].second == value) index = i;
    }
    on_choice(key, index, texts, doc);
    value = allowed[index].second;
  }

  // One of `texts`, by its number.
  void choice(const char* key, std::size_t& index, const std::vector<const char*>& texts,
              const char* doc) {
    on_choice(key, index, texts, doc);
  }

  template <class Struct>
  void section(const char* key, Struct& value, const char* doc) {
    begin_section(key, doc);
    visit(*this, value);
    end_section();
  }

  // An object whose keys are free and whose values are all of one kind.
  void strings(const char* key, std::map<std::string, std::string>& value, const char* doc) {
    begin_section(key, doc);
    for (const std::string& name : free_keys(keys_of(value)))
      on_string(name.c_str(), value[name], "");
    end_section();
  }
  template <class Struct>
  void sections(const char* key, std::map<std::string, Struct>& value, const char* doc) {
    begin_section(key, doc);
    for (const std::string& name : free_keys(keys_of(value)))
      section(name.c_str(), value[name], "");
    end_section();
  }

 protected:
  virtual void on_bool(const char* key, bool& value, const char* doc) = 0;
  virtual void on_string(const char* key, std::string& value, const char* doc) = 0;
  virtual void on_real(const char* key, double& value, ConfigRange range, const char* doc) = 0;
  virtual void on_open_real(const char* key, std::optional<double>& value, ConfigRange range,
                            const char* doc) = 0;
  virtual void on_reals(const char* key, std::vector<double>& value, ConfigRange range,
                        const char* doc) = 0;
  virtual void on_integer(const char* key, std::int64_t& value, ConfigRange range,
                          const char* doc) = 0;
  // `index` chooses one of `allowed`.
  virtual void on_choice(const char* key, std::size_t& index,
                         const std::vector<const char*>& allowed, const char* doc) = 0;
  virtual void begin_section(const char* key, const char* doc) = 0;
  virtual void end_section() = 0;
  // Keys of the section that has begun: a writer's are the struct's, a reader adds its own.
  virtual std::vector<std::string> free_keys(const std::vector<std::string>& present) = 0;

 private:
  template <class Map>
  static std::vector<std::string> keys_of(const Map& map) {
    std::vector<std::string> keys;
    for (const auto& entry : map) keys.push_back(entry.first);
    return keys;
  }
};

}  // namespace sgs
