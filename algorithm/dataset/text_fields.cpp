// Conversions of text_fields.h.
#include "algorithm/dataset/text_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

constexpr std::string_view kSpace = " \t\r\n\v\f";

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace

bool is_number(std::string_view text) { return number_of(text).has_value(); }

TextFields::TextFields(std::string_view text, std::string where)
    : text_(text), where_(std::move(where)) {
  skip_space();
}

void TextFields::skip_space() {
  text_.remove_prefix(std::min(text_.find_first_not_of(kSpace), text_.size()));
}

std::string_view TextFields::word(const char* what) {
  if (at_end()) throw InputError(fmt::format("{}: ends, expected {}", where_, what));
  const std::string_view found = text_.substr(0, text_.find_first_of(kSpace));
  text_.remove_prefix(found.size());
  skip_space();
  return found;
}

double TextFields::any_number(const char* what) {
  const std::string_view found = word(what);
  const auto value = number_of(found);
  if (!value)
    throw InputError(fmt::format("{}: {}: got '{}', expected a number", where_, what, found));
  return *value;
}

double TextFields::number(const char* what) {
  const std::string_view found = word(what);
  const auto value = number_of(found);
  if (!value || !std::isfinite(*value)) {
    throw InputError(
        fmt::format("{}: {}: got '{}', expected a finite number", where_, what, found));
  }
  return *value;
}

std::uint64_t TextFields::whole_number(const char* what, std::uint64_t most) {
  const std::string_view found = word(what);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error != std::errc() || end != found.data() + found.size() || value > most) {
    throw InputError(fmt::format("{}: {}: got '{}', expected a whole number from 0 to {}", where_,
                                 what, found, most));
  }
  return value;
}

std::string_view TextFields::rest(const char* what) {
  if (at_end()) throw InputError(fmt::format("{}: ends, expected {}", where_, what));
  const std::string_view found = text_.substr(0, text_.find_last_not_of(kSpace) + 1);
  text_ = {};
  return found;
}

void TextFields::expect_end() const {
  if (!at_end()) {
    throw InputError(fmt::format("{}: got '{}', expected the end", where_, text_.substr(0, 40)));
  }
}

}  // namespace sgs
