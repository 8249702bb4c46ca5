// The validators of option_checks.h.
#include "testbench/command_line/option_checks.h"

#include <fmt/format.h>

#include <charconv>

namespace sgs {
namespace {

// Whether all of `text` is a number of the type of `value`.
template <class Number>
bool read(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

template <class Number>
CLI::Validator in_interval(Number lo, Number hi, const char* kind) {
  const std::string allowed = fmt::format("{} from {} to {}", kind, lo, hi);
  return CLI::Validator(
      [=](const std::string& text) {
        Number value{};
        const bool good = read(text, value) && value >= lo && value <= hi;
        return good ? std::string() : fmt::format("got '{}', expected {}", text, allowed);
      },
      fmt::format("in [{}, {}]", lo, hi));
}

}  // namespace

CLI::Validator whole_number(std::uint64_t lo, std::uint64_t hi) {
  return in_interval(lo, hi, "a whole number");
}

CLI::Validator real_number(double lo, double hi) { return in_interval(lo, hi, "a number"); }

CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& text) {
        return text.empty() ? std::string("got nothing, expected a name") : std::string();
      },
      "");
}

}  // namespace sgs
