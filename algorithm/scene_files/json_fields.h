// Members of a JSON object, each refused by name where it is missing or of another type.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sgs {

class JsonFields {
 public:
  using Json = nlohmann::ordered_json;

  // origin: the file and the place in it, for messages. Throws InputError where `json` is no
  // object.
  JsonFields(std::string origin, const Json& json);

  const std::string& origin() const { return origin_; }
  bool has(const std::string& name) const { return json_.contains(name); }
  // All of these throw InputError.
  const Json& at(const std::string& name) const;
  JsonFields object(const std::string& name) const;
  std::string text(const std::string& name) const;
  // A whole number of 0 to `most`.
  std::uint64_t whole(const std::string& name,
                      std::uint64_t most = std::numeric_limits<std::uint32_t>::max()) const;
  // `or_else` where there is none.
  std::uint64_t whole_or(const std::string& name, std::uint64_t or_else,
                         std::uint64_t most = std::numeric_limits<std::uint32_t>::max()) const {
    return has(name) ? whole(name, most) : or_else;
  }
  const Json& list(const std::string& name) const;
  std::vector<double> numbers(const std::string& name, std::size_t count) const;
  std::vector<double> numbers(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;

  [[noreturn]] void refuse(const std::string& name, const std::string& expected) const;

 private:
  std::string origin_;
  const Json& json_;
};

}  // namespace sgs
