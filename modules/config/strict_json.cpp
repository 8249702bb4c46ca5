// Configurations as JSON, read without mercy.
#include "modules/config/strict_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "modules/config/unknown_key.h"

namespace sgs {

namespace {
using Json = nlohmann::ordered_json;

Json object_of(Json json, const std::string& origin) {
  if (!json.is_object())
    throw InputError(
        fmt::format("{}: got a JSON {}, expected an object", origin, json.type_name()));
  return json;
}
}  // namespace

struct ConfigDocument::Content {
  Json root = Json::object();
  std::map<std::string, std::string> origins;  // by path of the value

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

  // Refuses misplaced keys, after the visit to a section alone.
  void check_misplaced(const char* section) const {
    for (const auto& item : levels_.front().json->items()) {
      if (section_keys_.count(item.key()) == 0) continue;
      throw InputError(fmt::format("{}: {}: got it outside of {}, expected {}.{}",
                                   origin_of(item.key()), item.key(), section, section,
                                   item.key()));
    }
  }

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
    value = checked_real(key, *json, range, "");
  }

  void on_open_real(const char* key, std::optional<double>& value, ConfigRange range,
                    const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    value.reset();
    if (!json->is_null()) value = checked_real(key, *json, range, ", or null");
  }

  void on_reals(const char* key, std::vector<double>& value, ConfigRange range,
                const char*) override {
    const Json* json = take(key);
    if (json == nullptr) return;
    if (!json->is_array()) refuse(key, *json, "an array of numbers");
    value.clear();
    for (const Json& element : *json) value.push_back(checked_real(key, element, range, ""));
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
    const std::vector<std::string> names(allowed.begin(), allowed.end());
    refuse(key, *json, "one of " + join(allowed),
           json->is_string() ? did_you_mean(json->get<std::string>(), names) : "");
  }

  void begin_section(const char* key, const char*) override {
    static const Json kNothing = Json::object();
    const Json* json = take(key);
    if (json != nullptr && !json->is_object()) {
      refuse(key, *json, "an object" + did_you_mean(key, levels_.back().without(key)));
    }
    levels_.push_back({json == nullptr ? &kNothing : json, path_of(key), {}});
  }

  void end_section() override {
    check_all_used(levels_.back());
    if (levels_.size() == 2) section_keys_ = levels_.back().known;
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

    std::vector<std::string> without(const std::string& key) const {
      std::vector<std::string> others;
      std::copy_if(known.begin(), known.end(), std::back_inserter(others),
                   [&](const std::string& other) { return other != key; });
      return others;
    }
  };

  std::string path_of(const std::string& key) const {
    return levels_.back().path.empty() ? key : levels_.back().path + "." + key;
  }

  const Json* take(const char* key) {
    Level& level = levels_.back();
    level.known.insert(key);
    paths_.push_back(path_of(key));
    const auto found = level.json->find(key);
    return found == level.json->end() ? nullptr : &*found;
  }

  // otherwise: what else than such a number it may be, as ", or ...".
  double checked_real(const char* key, const Json& json, ConfigRange range,
                      const char* otherwise) const {
    const std::string allowed = fmt::format("a number in [{}, {}]{}", static_cast<double>(range.lo),
                                            static_cast<double>(range.hi), otherwise);
    if (!json.is_number()) refuse(key, json, allowed);
    const double value = json.get<double>();
    if (!(value >= range.lo && value <= range.hi)) refuse(key, json, allowed);
    return value;
  }

  std::string origin_of(const std::string& path) const {
    const auto found = origins_.find(path);
    return found == origins_.end() ? "configuration" : found->second;
  }

  // question: of did_you_mean().
  [[noreturn]] void refuse(const char* key, const Json& got, const std::string& allowed,
                           const std::string& question = "") const {
    const std::string path = path_of(key);
    throw InputError(fmt::format("{}: {}: got {}{}{}", origin_of(path), path, shown(got),
                                 then_expected(question), allowed));
  }

  void check_all_used(const Level& level) const {
    for (const auto& item : level.json->items()) {
      if (level.known.count(item.key()) > 0) continue;
      const std::string path = level.path.empty() ? item.key() : level.path + "." + item.key();
      const auto nearest = nearest_key(path, paths_);
      throw UnknownKey(
          fmt::format("{}: {}: unknown key{}{}", origin_of(path), path,
                      then_expected(nearest ? "; did you mean " + paths_[*nearest] + "?" : ""),
                      level.known.empty() ? "none" : "one of " + join(level.known)),
          path);
    }
  }

  const std::map<std::string, std::string>& origins_;
  std::vector<Level> levels_;
  std::vector<std::string> paths_;      // of all keys so far
  std::set<std::string> section_keys_;  // known keys of the last section of the top level
};

}  // namespace

ConfigDocument::ConfigDocument() : content_(std::make_unique<Content>()) {}
ConfigDocument::~ConfigDocument() = default;
ConfigDocument::ConfigDocument(ConfigDocument&&) noexcept = default;
ConfigDocument& ConfigDocument::operator=(ConfigDocument&&) noexcept = default;

void ConfigDocument::add_file(const std::string& path, const std::string& origin) {
  content_->merge(content_->root, object_of(read_json(path), path), "", origin);
}

void ConfigDocument::add_text(const std::string& text, const std::string& origin) {
  content_->merge(content_->root, object_of(parse_json(text, origin), origin), "", origin);
}

void ConfigDocument::add(const ConfigDocument& other) {
  content_->merge(content_->root, other.content_->root, "", "");
  for (const auto& [path, origin] : other.content_->origins) content_->origins[path] = origin;
}

void ConfigDocument::add_override(const std::string& assignment) {
  constexpr std::size_t kMostShownBytes = 100;
  const std::string origin = "--set " + (assignment.size() <= kMostShownBytes
                                             ? assignment
                                             : assignment.substr(0, kMostShownBytes) + "...");
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format("{}: got no '=' after a key, expected key.path=value", origin));
  const std::string path = assignment.substr(0, equals);
  if (std::count(path.begin(), path.end(), '.') >= kMostJsonDepth)
    throw InputError(fmt::format("{}: got more than {} keys in each other, expected fewer", origin,
                                 kMostJsonDepth));
  const std::string text = assignment.substr(equals + 1);
  Json nested = Json::accept(text) ? parse_json(text, origin) : Json(text);
  std::size_t end = path.size();
  while (true) {
    const std::size_t dot = path.rfind('.', end - 1);
    const std::size_t begin = dot == std::string::npos ? 0 : dot + 1;
    const std::string key = path.substr(begin, end - begin);
    if (key.empty())
      throw InputError(fmt::format("{}: got an empty key, expected key.path=value", origin));
    Json outer = Json::object();
    outer[key] = std::move(nested);
    nested = std::move(outer);
    if (begin < 2) break;
    end = begin - 1;
  }
  content_->merge(content_->root, nested, "", origin);
}

std::string ConfigDocument::text_at(const std::string& key) const {
  const auto found = content_->root.find(key);
  return found != content_->root.end() && found->is_string() ? found->get<std::string>() : "";
}

std::string ConfigDocument::take_text(const std::string& key, const std::string& expected) {
  const auto found = content_->root.find(key);
  if (found == content_->root.end()) return "";
  if (!found->is_string()) {
    throw InputError(fmt::format("{}: {}: got {}, expected {}", content_->origins[key], key,
                                 shown(*found), expected));
  }
  const std::string text = found->get<std::string>();
  content_->root.erase(found);
  content_->origins.erase(key);
  return text;
}

std::vector<ConfigOrigin> ConfigDocument::origins() const {
  std::vector<ConfigOrigin> values;
  for (const auto& [path, origin] : content_->origins) {
    std::string pointer = "/" + path;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const Json::json_pointer place(pointer);
    if (content_->root.contains(place) && !content_->root[place].is_object()) {
      values.push_back({path, origin});
    }
  }
  return values;
}

std::unique_ptr<ConfigVisitor> ConfigDocument::make_reader() const {
  return std::make_unique<JsonReader>(content_->root, content_->origins);
}

void ConfigDocument::finish_section(const ConfigVisitor& reader, const char* section) {
  static_cast<const JsonReader&>(reader).check_misplaced(section);
}

void ConfigDocument::finish(const ConfigVisitor& reader) {
  static_cast<const JsonReader&>(reader).check_root();
}

}  // namespace sgs
