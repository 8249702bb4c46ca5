// Configurations drawn at random from the keys and ranges that a machine states.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace sgs::test {

// A key as `streaminggs describe` prints it.
struct StatedKey {
  std::string name, value;           // with the preset's value
  std::vector<std::string> choices;  // of a key that is one of several words; else empty
  double low = 0, high = 0;          // of a key that is a number
};

// All keys of a preset but those that are names of files or seeds.
std::vector<StatedKey> stated_keys(const std::string& preset);

// "key=value" for about `count` of them: ends of the range, beside these, and around the preset's
// value.
std::vector<std::string> drawn_settings(std::mt19937_64& random, const std::string& preset,
                                        int count);

}  // namespace sgs::test
