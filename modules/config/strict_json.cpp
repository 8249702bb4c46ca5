// Configurations as JSON, read without mercy.
#include "modules/config/strict_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/input_error.h"
#include "modules/config/join.h"

namespace sgs {

namespace {
using Json = nlohmann::ordered_json;

// nlohmann keeps the last of two equal keys without a word; this parse refuses them.
Json parse_object(const std::string& text, const std::string& origin) {
  std::vector<std::set<std::string>> open_objects;
  const auto watch = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) open_objects.emplace_back();
    if (event == Json::parse_event_t::object_end) open_objects.pop_back();
    if (event == Json::parse_event_t::key &&
        !open_objects.back().insert(parsed.get<std::string>()).second)
      throw InputError(fmt::format("{}: key '{}' twice in one object, expected once", origin,
                                   parsed.get<std::string>()));
    return true;
  };
  Json json;
  try {
    json = Json::parse(text, watch, true, true);
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}: byte {}: not JSON ({})", origin, error.byte, error.what()));
  }
  if (!json.is_object())
    throw InputError(
        fmt::format("{}: got a JSON {}, expected an object", origin, json.type_name()));
  return json;
}
}  // namespace

struct ConfigDocument::Content {
  Json root = Json::object();
  std::map<std::string, std::string> origins;  // of each leaf's path

  void merge(Json& into, const Json& from, const std::string& path, const std::string& origin) {
    for (const auto& [key, value] : from.items()) {
      const std::string key_path = path.empty() ? key : path + "." + key;
      if (value.is_object()) {
        if (!into.contains(key) || !into[key].is_object()) into[key] = Json::object();
        origins[key_path] = origin;
        merge(into[key], value, key_path, origin);
      } else {
        into[key] = value;
        origins[key_path] = origin;
      }
    }
  }
};

namespace {

class JsonReader : public ConfigVisitor {
 public:
  JsonReader(const Json& root, const std::map<std::string, std::string>& origins)
      : origins_(origins) {
    levels_.push_back({&root, "", {}});
  }

  void check_root() const { check_all_used(levels_.front()); }

 protected:
  void on_bool(const char* key, bool& value, const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    if (!json->is_boolean()) refuse(key, *json, "true or false");
    value = json->get<bool>();
  }

  void on_string(const char* key, std::string& value, const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    if (!json->is_string()) refuse(key, *json, "a string");
    value = json->get<std::string>();
  }

  void on_real(const char* key, double& value, ConfigRange range, const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    value = checked_real(key, *json, range);
  }

  void on_reals(const char* key, std::vector<double>& value, ConfigRange range,
                const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    if (!json->is_array()) refuse(key, *json, "an array of numbers");
    value.clear();
    for (const Json& element : *json) value.push_back(checked_real(key, element, range));
  }

  void on_integer(const char* key, std::int64_t& value, ConfigRange range, const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    const std::string allowed =
        fmt::format("an integer in [{}, {}]", static_cast<std::int64_t>(range.lo),
                    static_cast<std::int64_t>(range.hi));
    if (!json->is_number_integer()) refuse(key, *json, allowed);
    const long double wide = json->is_number_unsigned()
                                 ? static_cast<long double>(json->get<std::uint64_t>())
                                 : static_cast<long double>(json->get<std::int64_t>());
    if (wide < range.lo || wide > range.hi) refuse(key, *json, allowed);
    value = json->get<std::int64_t>();
  }

  void on_choice(const char* key, std::size_t& index, const std::vector<const char*>& allowed,
                 const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    if (json->is_string())
      for (std::size_t i = 0; i < allowed.size(); ++i)
        if (json->get<std::string>() == allowed[i]) {
          index = i;
          return;
        }
    refuse(key, *json, "one of " + join(allowed));
  }

  void begin_section(const char* key, const char*) override {
    static const Json kNothing = Json::object();
    const Json* json = take(key);
    if (json != nullptr && !json->is_object()) refuse(key, *json, "an object");
    levels_.push_back({json == nullptr ? &kNothing : json, path_of(key), {}});
  }

  void end_section() override {
    check_all_used(levels_.back());
    levels_.pop_back();
  }

  std::vector<std::string> free_keys(const std::vector<std::string>& present) override {
    std::vector<std::string> all = present;
    for (const auto& item : levels_.back().json->items())
      if (std::find(all.begin(), all.end(), item.key()) == all.end()) all.push_back(item.key());
    return all;
  }

 private:
  struct Level {
    const Json* json;
    std::string path;
    std::set<std::string> known;
  };

  std::string path_of(const std::string& key) const {
    return levels_.back().path.empty() ? key : levels_.back().path + "." + key;
  }

  const Json* take(const char* key) {
    Level& level = levels_.back();
    level.known.insert(key);
    const auto found = level.json->find(key);
    return found == level.json->end() ? nullptr : &*found;
  }

  double checked_real(const char* key, const Json& json, ConfigRange range) const {
    const std::string allowed = fmt::format("a number in [{}, {}]", static_cast<double>(range.lo),
                                            static_cast<double>(range.hi));
    if (!json.is_number()) refuse(key, json, allowed);
    const double value = json.get<double>();
    if (!(value >= range.lo && value <= range.hi)) refuse(key, json, allowed);
    return value;
  }

  std::string origin_of(const std::string& path) const {
    const auto found = origins_.find(path);
    return found == origins_.end() ? "configuration" : found->second;
  }

  [[noreturn]] void refuse(const char* key, const Json& got, const std::string& allowed) const {
    const std::string path = path_of(key);
    throw InputError(
        fmt::format("{}: {}: got {}, expected {}", origin_of(path), path, got.dump(), allowed));
  }

  void check_all_used(const Level& level) const {
    for (const auto& item : level.json->items()) {
      if (level.known.count(item.key()) > 0) continue;
      const std::string path = level.path.empty() ? item.key() : level.path + "." + item.key();
      throw InputError(fmt::format("{}: {}: unknown key, expected {}", origin_of(path), path,
                                   level.known.empty() ? "none" : "one of " + join(level.known)));
    }
  }

  const std::map<std::string, std::string>& origins_;
  std::vector<Level> levels_;
};

}  // namespace

ConfigDocument::ConfigDocument() : content_(std::make_unique<Content>()) {}
ConfigDocument::~ConfigDocument() = default;
ConfigDocument::ConfigDocument(ConfigDocument&&) noexcept = default;
ConfigDocument& ConfigDocument::operator=(ConfigDocument&&) noexcept = default;

void ConfigDocument::add_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.good() && !file.eof())
    throw InputError(fmt::format("{}: cannot be read, expected a JSON file", path));
  add_text(text, path);
}

void ConfigDocument::add_text(const std::string& text, const std::string& origin) {
  content_->merge(content_->root, parse_object(text, origin), "", origin);
}

void ConfigDocument::add_override(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(
        fmt::format("--set {}: got no '=' after a key, expected key.path=value", assignment));
  const std::string path = assignment.substr(0, equals);
  const std::string text = assignment.substr(equals + 1);
  Json value = Json::parse(text, nullptr, false);
  if (value.is_discarded()) value = text;
  Json nested = std::move(value);
  std::size_t end = path.size();
  while (true) {
    const std::size_t dot = path.rfind('.', end - 1);
    const std::size_t begin = dot == std::string::npos ? 0 : dot + 1;
    const std::string key = path.substr(begin, end - begin);
    if (key.empty())
      throw InputError(
          fmt::format("--set {}: got an empty key, expected key.path=value", assignment));
    Json outer = Json::object();
    outer[key] = std::move(nested);
    nested = std::move(outer);
    if (begin < 2) break;
    end = begin - 1;
  }
  content_->merge(content_->root, nested, "", "--set " + assignment);
}

std::unique_ptr<ConfigVisitor> ConfigDocument::make_reader() const {
  return std::make_unique<JsonReader>(content_->root, content_->origins);
}

void ConfigDocument::finish(const ConfigVisitor& reader) {
  static_cast<const JsonReader&>(reader).check_root();
}

}  // namespace sgs
