// The watch over nlohmann's parser, and the types of what it gives.
#include "algorithm/files/input_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostFileBytes = std::uint64_t{256} << 20;
// Finding a key in an ordered object takes time in proportion to the number of keys.
constexpr std::size_t kMostKeys = 10000;

// Called by the parser for what it meets; throws InputError.
class Watch {
 public:
  explicit Watch(const std::string& origin) : origin_(origin) {}

  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      if (depth >= kMostJsonDepth) {
        throw InputError(
            fmt::format("{}: objects and arrays in each other more than {} deep, "
                        "expected at most that",
                        origin_, kMostJsonDepth));
      }
    }
    if (event == Event::object_start) open_objects_.emplace_back();
    if (event == Event::object_end) open_objects_.pop_back();
    if (event == Event::key) add_key(parsed.get_ref<const std::string&>());
    return true;
  }

 private:
  void add_key(const std::string& key) {
    std::set<std::string>& keys = open_objects_.back();
    if (!keys.insert(key).second) {
      throw InputError(
          fmt::format("{}: key '{}' twice in one object, expected once", origin_, key));
    }
    if (keys.size() > kMostKeys) {
      throw InputError(fmt::format("{}: key '{}': more than {} keys in one object, expected fewer",
                                   origin_, key, kMostKeys));
    }
  }

  const std::string& origin_;
  std::vector<std::set<std::string>> open_objects_;
};

// "line 3, column 7", of the byte with this number, from 1.
std::string place_in(const std::string& text, std::size_t byte) {
  const std::string before = text.substr(0, byte == 0 ? 0 : byte - 1);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t begin = lines == 0 ? 0 : before.rfind('\n') + 1;
  return fmt::format("line {}, column {}", lines + 1, before.size() - begin + 1);
}

// What the parser says, without its names and its own way to count.
std::string reason_of(const Json::exception& error) {
  const std::string told = error.what();
  for (const char* before : {" - ", "] "}) {
    const std::size_t at = told.find(before);
    if (at != std::string::npos) return told.substr(at + std::string(before).size());
  }
  return told;
}

}  // namespace

Json parse_json(const std::string& text, const std::string& origin) {
  Watch watch(origin);
  try {
    return Json::parse(
        text,
        [&](int depth, Json::parse_event_t event, Json& parsed) {
          return watch(depth, event, parsed);
        },
        true, true);
  } catch (const Json::parse_error& error) {
    throw InputError(
        fmt::format("{}: {}: not JSON: {}", origin, place_in(text, error.byte), reason_of(error)));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not JSON: {}", origin, reason_of(error)));
  }
}

Json read_json(const std::string& path) {
  const InputFile file(path);
  if (file.size_bytes() > kMostFileBytes) {
    throw InputError(fmt::format("{}: got {} bytes, expected JSON of at most {}", path,
                                 file.size_bytes(), kMostFileBytes));
  }
  return parse_json(file.text_from(0, file.size_bytes()), path);
}

std::string shown(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

namespace {

// A long object or array by its size.
std::string in_short(const Json& json) {
  constexpr std::size_t kMostBytes = 100;
  const char* kind = json.is_object() ? "an object" : json.is_array() ? "an array" : nullptr;
  if (kind != nullptr && json.size() > kMostBytes)
    return fmt::format("{} of {}", kind, json.size());
  const std::string text = shown(json);
  if (kind == nullptr || text.size() <= kMostBytes) return text;
  return fmt::format("{} of {}", kind, json.size());
}

}  // namespace

JsonPlace JsonPlace::below(const std::string& path, const Json& json) const {
  JsonPlace place(where_, json);
  place.path_ = path;
  return place;
}

JsonPlace JsonPlace::with_defaults(const Json& defaults) const {
  JsonPlace place = *this;
  place.defaults_ = &defaults;
  return place;
}

std::optional<JsonPlace> JsonPlace::find(const std::string& key) const {
  if (!json_->is_object()) refuse("an object");
  for (const Json* object : {json_, defaults_}) {
    if (object == nullptr) continue;
    const auto found = object->find(key);
    if (found != object->end()) return below(path_.empty() ? key : path_ + "." + key, *found);
  }
  return {};
}

JsonPlace JsonPlace::at(const std::string& key, const std::string& expected) const {
  if (auto found = find(key)) return *std::move(found);
  below(path_.empty() ? key : path_ + "." + key, *json_).refuse("nothing", expected);
}

std::vector<std::pair<std::string, JsonPlace>> JsonPlace::members() const {
  if (!json_->is_object()) refuse("an object");
  std::vector<std::pair<std::string, JsonPlace>> all;
  for (const auto& [key, value] : json_->items()) {
    all.emplace_back(key, below(path_.empty() ? key : path_ + "." + key, value));
  }
  return all;
}

std::vector<std::string> JsonPlace::keys_beside(const std::vector<std::string>& known) const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json_->items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) keys.push_back(key);
  }
  return keys;
}

void JsonPlace::expect_only(const std::vector<std::string>& known) const {
  const std::vector<std::string> others = keys_beside(known);
  if (others.empty()) return;
  throw InputError(fmt::format("{}: {}: unknown key, expected one of {}{}", name(), others[0],
                               join(known), did_you_mean(others[0], known)));
}

std::vector<JsonPlace> JsonPlace::elements(const std::string& expected) const {
  if (!json_->is_array()) refuse(expected);
  std::vector<JsonPlace> all;
  for (const Json& value : *json_) {
    all.push_back(below(fmt::format("{}[{}]", path_, all.size()), value));
  }
  return all;
}

bool JsonPlace::flag() const {
  if (!json_->is_boolean()) refuse("true or false");
  return json_->get<bool>();
}

double JsonPlace::number() const {
  if (!json_->is_number() || !std::isfinite(json_->get<double>())) refuse("a finite number");
  return json_->get<double>();
}

std::string JsonPlace::text() const {
  if (!json_->is_string()) refuse("a text");
  return json_->get<std::string>();
}

std::int64_t JsonPlace::whole(std::int64_t least, std::int64_t most, const std::string& of) const {
  const double number = json_->is_number() ? json_->get<double>() : NAN;
  // Compared as double, which is exact to 2^53.
  if (!(number >= static_cast<double>(least) && number <= static_cast<double>(most)) ||
      number != std::floor(number)) {
    refuse(fmt::format("a whole number{} from {} to {}", of, least, most));
  }
  return json_->is_number_integer() ? json_->get<std::int64_t>()
                                    : static_cast<std::int64_t>(number);
}

std::int64_t JsonPlace::whole_or(const std::string& key, std::int64_t or_else,
                                 std::int64_t most) const {
  const auto found = find(key);
  return found ? found->whole(0, most) : or_else;
}

std::vector<double> JsonPlace::numbers(std::optional<std::size_t> count) const {
  const std::string expected = count ? fmt::format("{} numbers", *count) : "a list of numbers";
  std::vector<double> values;
  for (const JsonPlace& element : elements(expected)) values.push_back(element.number());
  if (count && values.size() != *count) refuse(expected);
  return values;
}

std::vector<std::string> JsonPlace::texts() const {
  std::vector<std::string> values;
  for (const JsonPlace& element : elements()) values.push_back(element.text());
  return values;
}

void JsonPlace::refuse(const std::string& expected) const { refuse(in_short(*json_), expected); }

void JsonPlace::refuse(const std::string& got, const std::string& expected) const {
  throw InputError(fmt::format("{}: got {}, expected {}", name(), got, expected));
}

}  // namespace sgs
