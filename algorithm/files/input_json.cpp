// The watch over nlohmann's parser.
#include "algorithm/files/input_json.h"

#include <fmt/format.h>

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
    throw InputError(fmt::format("{}: byte {}: not JSON ({})", origin, error.byte, error.what()));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not JSON ({})", origin, error.what()));
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

}  // namespace sgs
