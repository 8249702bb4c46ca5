// Data sets with something wrong in them, and the check that they are refused.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/algorithm/dataset/made_datasets.h"

namespace sgs::test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using WriteDataset = void (*)(const std::string& folder, const PhotographedScene& scene);
using Damage = std::function<void(const std::string& folder)>;

// Puts `to` where `from` first is in folder/name.
Damage replace(const std::string& name, const std::string& from, const std::string& to);

// The same wherever `from` is.
Damage replace_all(const std::string& name, const std::string& from, const std::string& to);

// Moves folder/from to folder/to.
Damage move_to(const std::string& from, const std::string& to);

// Writes folder/name, with these bytes.
Damage with(const std::string& name, const std::string& bytes);

Damage without(const std::string& name);

// The picture in folder/name as it would be with other sides.
Damage resize(const std::string& name, int width, int height);

struct DamagedDataset {
  WriteDataset write;
  Damage damage;
  std::vector<std::string> words;  // of the message
};

// Each is refused in words of its own.
void check_refused(const std::vector<DamagedDataset>& datasets);

}  // namespace sgs::test
