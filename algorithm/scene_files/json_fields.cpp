// Types of the members.
#include "algorithm/scene_files/json_fields.h"

#include <fmt/format.h>

#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {

JsonFields::JsonFields(std::string origin, const Json& json)
    : origin_(std::move(origin)), json_(json) {
  if (!json.is_object()) {
    throw InputError(fmt::format("{}: got {}, expected an object", origin_, shown(json)));
  }
}

void JsonFields::refuse(const std::string& name, const std::string& expected) const {
  throw InputError(fmt::format("{}: {}: got {}, expected {}", origin_, name,
                               has(name) ? shown(json_[name]) : "none", expected));
}

const JsonFields::Json& JsonFields::at(const std::string& name) const {
  if (!has(name)) refuse(name, "it");
  return json_[name];
}

JsonFields JsonFields::object(const std::string& name) const {
  if (!has(name) || !json_[name].is_object()) refuse(name, "an object");
  return {fmt::format("{}: {}", origin_, name), json_[name]};
}

std::string JsonFields::text(const std::string& name) const {
  if (!has(name) || !json_[name].is_string()) refuse(name, "a text");
  return json_[name].get<std::string>();
}

std::uint64_t JsonFields::whole(const std::string& name, std::uint64_t most) const {
  if (!has(name) || !json_[name].is_number_unsigned() || json_[name].get<std::uint64_t>() > most) {
    refuse(name, fmt::format("a whole number of 0 to {}", most));
  }
  return json_[name].get<std::uint64_t>();
}

const JsonFields::Json& JsonFields::list(const std::string& name) const {
  if (!has(name) || !json_[name].is_array()) refuse(name, "a list");
  return json_[name];
}

std::vector<double> JsonFields::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const Json& value : list(name)) {
    if (!value.is_number()) refuse(name, "numbers only");
    values.push_back(value.get<double>());
  }
  return values;
}

std::vector<double> JsonFields::numbers(const std::string& name, std::size_t count) const {
  std::vector<double> values = numbers(name);
  if (values.size() != count) refuse(name, fmt::format("{} numbers", count));
  return values;
}

std::vector<std::string> JsonFields::texts(const std::string& name) const {
  std::vector<std::string> values;
  for (const Json& value : list(name)) {
    if (!value.is_string()) refuse(name, "texts only");
    values.push_back(value.get<std::string>());
  }
  return values;
}

}  // namespace sgs
