// A change of the configuration that shortens the busy or waiting cycles of an activity.
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
  Remedy(const char* of, Turn way = Turn::kUp) : key(of), turn(way) {}
  Remedy(std::string of, Turn way = Turn::kUp) : key(std::move(of)), turn(way) {}

  bool known() const { return !key.empty(); }

  std::string key;  // empty: nothing is known
  Turn turn = Turn::kUp;
};

}  // namespace sgs
