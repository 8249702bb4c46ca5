// A value of a JSON file, and where it stands in it: what is not as expected is refused by name.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {

// The document outlives it.
class JsonPlace {
 public:
  using Json = nlohmann::ordered_json;

  JsonPlace(std::string file, const Json& json) : file_(std::move(file)), json_(&json) {}

  const Json& json() const { return *json_; }

  bool has(const std::string& key) const { return json_->is_object() && json_->contains(key); }

  // Throws InputError where there is none.
  JsonPlace at(const std::string& key) const {
    if (!json_->is_object()) fail("an object");
    const auto found = json_->find(key);
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (found == json_->end()) {
      throw InputError(fmt::format("{}: {}: got nothing, expected that key", file_, path));
    }
    return {file_, path, *found};
  }
  JsonPlace at(std::size_t index) const {
    return {file_, fmt::format("{}[{}]", path_, index), json_->at(index)};
  }

  // Their number.
  std::size_t entries() const {
    if (!json_->is_array()) fail("a list");
    return json_->size();
  }
  // takes(key, place) for each of an object.
  template <class Takes>
  void each(const Takes& takes) const {
    if (!json_->is_object()) fail("an object");
    for (const auto& [key, value] : json_->items()) takes(key, at(key));
  }

  double number() const {
    if (!json_->is_number()) fail("a number");
    return json_->get<double>();
  }
  std::string text() const {
    if (!json_->is_string()) fail("a text");
    return json_->get<std::string>();
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw InputError(fmt::format("{}: {}: got {}, expected {}", file_,
                                 path_.empty() ? "the document" : path_, shown(*json_), expected));
  }

 private:
  JsonPlace(std::string file, std::string path, const Json& json)
      : file_(std::move(file)), path_(std::move(path)), json_(&json) {}

  std::string file_, path_;
  const Json* json_;
};

}  // namespace sgs
