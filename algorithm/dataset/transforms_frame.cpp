// The keys of a frame.
#include "algorithm/dataset/transforms_frame.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {

TransformsFrame::TransformsFrame(const Json& file, const Json& frame, std::string where)
    : file_(file), frame_(frame), where_(std::move(where)) {
  if (!frame.is_object()) {
    throw InputError(fmt::format("{}: got {}, expected an object", where_, frame.type_name()));
  }
}

void TransformsFrame::fail(const std::string& key, const std::string& got,
                           const char* expected) const {
  throw InputError(fmt::format("{}: {}: got {}, expected {}", where_, key, got, expected));
}

const TransformsFrame::Json* TransformsFrame::find(const char* key) const {
  for (const Json* object : {&frame_, &file_}) {
    const auto found = object->find(key);
    if (found != object->end()) return &*found;
  }
  return nullptr;
}

double TransformsFrame::finite(const std::string& key, const Json& value) const {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    fail(key, shown(value), "a finite number");
  }
  return value.get<double>();
}

std::optional<double> TransformsFrame::number(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  return finite(key, *value);
}

std::optional<std::string> TransformsFrame::text(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  if (!value->is_string()) fail(key, shown(*value), "a text");
  return value->get<std::string>();
}

bool TransformsFrame::flag(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return false;
  if (!value->is_boolean()) fail(key, shown(*value), "true or false");
  return value->get<bool>();
}

std::vector<double> TransformsFrame::numbers(const char* key) const {
  const Json* values = find(key);
  if (values == nullptr) return {};
  if (!values->is_array()) fail(key, shown(*values), "an array of numbers");
  std::vector<double> out;
  for (const Json& value : *values) {
    out.push_back(finite(fmt::format("{}[{}]", key, out.size()), value));
  }
  return out;
}

glm::dmat4 TransformsFrame::matrix(const char* key) const {
  const Json* rows = find(key);
  if (rows == nullptr) fail(key, "nothing", "4 rows of 4 numbers");
  if (!rows->is_array() || rows->size() < 3 || rows->size() > 4) {
    fail(key, shown(*rows), "4 rows of 4 numbers");
  }
  glm::dmat4 columns(1.0);
  for (int row = 0; row < static_cast<int>(rows->size()); ++row) {
    const Json& numbers = (*rows)[static_cast<std::size_t>(row)];
    const std::string place = fmt::format("{}[{}]", key, row);
    if (!numbers.is_array() || numbers.size() != 4) fail(place, shown(numbers), "4 numbers");
    for (int column = 0; column < 4; ++column) {
      columns[column][row] =
          finite(fmt::format("{}[{}]", place, column), numbers[static_cast<std::size_t>(column)]);
    }
  }
  return columns;
}

}  // namespace sgs
