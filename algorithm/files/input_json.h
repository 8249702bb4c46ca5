// JSON from files and arguments, read without mercy.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sgs {

// Objects and arrays within each other; every one of a reader's steps into them may take stack.
constexpr int kMostJsonDepth = 64;

// Parses all of `text`; comments are allowed. `origin` stands for the file in messages. Throws
// InputError: not JSON, a number beyond double, a key twice in one object, deeper than
// kMostJsonDepth.
nlohmann::ordered_json parse_json(const std::string& text, const std::string& origin);

// The same for a file. Throws InputError, also when it is no regular file or larger than 256 MiB.
nlohmann::ordered_json read_json(const std::string& path);

// `json` as it may stand in a message.
std::string shown(const nlohmann::ordered_json& json);

// A value, and where it stands: what is not as expected is refused with file, place, what is there
// and what was expected. All functions throw InputError.
class JsonPlace {
 public:
  using Json = nlohmann::ordered_json;

  // where: the file, and what of it has a name of its own: "a.json: camera 3". The document must
  // outlive the place.
  JsonPlace(std::string where, const Json& json) : where_(std::move(where)), json_(&json) {}

  const Json& json() const { return *json_; }
  // "a.json: camera 3: position[1]"
  std::string name() const { return path_.empty() ? where_ : where_ + ": " + path_; }

  // The members of an object. What it lacks is looked for in `defaults`, which must outlive it.
  JsonPlace with_defaults(const Json& defaults) const;
  bool has(const std::string& key) const { return find(key).has_value(); }
  std::optional<JsonPlace> find(const std::string& key) const;
  JsonPlace at(const std::string& key, const std::string& expected = "that key") const;
  std::vector<std::pair<std::string, JsonPlace>> members() const;
  // Its own keys that are none of `known`: whoever reads a form of others counts them, whoever
  // reads one of ours refuses them.
  std::vector<std::string> keys_beside(const std::vector<std::string>& known) const;
  void expect_only(const std::vector<std::string>& known) const;

  // The elements of an array.
  std::vector<JsonPlace> elements(const std::string& expected = "a list") const;

  bool flag() const;
  double number() const;  // finite
  std::string text() const;
  // 640.0 is a whole number: some programs know no other. of: " of px"
  std::int64_t whole(std::int64_t least = 0, std::int64_t most = UINT32_MAX,
                     const std::string& of = "") const;
  // Of the member `key`; `or_else` where it is not there.
  std::int64_t whole_or(const std::string& key, std::int64_t or_else,
                        std::int64_t most = UINT32_MAX) const;
  std::vector<double> numbers(std::optional<std::size_t> count = {}) const;
  std::vector<std::string> texts() const;

  [[noreturn]] void refuse(const std::string& expected) const;
  [[noreturn]] void refuse(const std::string& got, const std::string& expected) const;

 private:
  JsonPlace below(const std::string& path, const Json& json) const;

  std::string where_, path_;
  const Json* json_;
  const Json* defaults_ = nullptr;
};

}  // namespace sgs
