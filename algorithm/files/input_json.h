// JSON from files and arguments, read without mercy.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

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

}  // namespace sgs
