// A table as text: fields separated by commas.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sgs {

// A line for each object, below the keys of the first; at least one. null: an empty field.
inline std::string csv_of(const nlohmann::ordered_json& lines) {
  std::string text;
  const auto add_line = [&](const nlohmann::ordered_json& line, const auto& field) {
    const char* comma = "";
    for (const auto& [key, value] : line.items()) {
      text += comma + field(key, value);
      comma = ",";
    }
    text += "\n";
  };
  add_line(lines.at(0), [](const std::string& key, const nlohmann::ordered_json&) { return key; });
  for (const nlohmann::ordered_json& line : lines) {
    add_line(line, [](const std::string&, const nlohmann::ordered_json& value) {
      if (value.is_null()) return std::string();
      return value.is_string() ? value.get<std::string>() : value.dump();
    });
  }
  return text;
}

}  // namespace sgs
