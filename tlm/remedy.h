// What to change in the configuration for less of some work or waiting.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace sgs {

enum class Turn : std::uint8_t {
  kUp,   // more of it: lanes, entries, banks
  kDown  // less of it: cycles that an operation takes
};

struct Remedy {
  Remedy() = default;
  Remedy(const char* key, Turn turn = Turn::kUp) : key(key), turn(turn) {}
  Remedy(std::string key, Turn turn = Turn::kUp) : key(std::move(key)), turn(turn) {}

  bool known() const { return !key.empty(); }

  std::string key;  // empty: nothing is known
  Turn turn = Turn::kUp;
};

}  // namespace sgs
