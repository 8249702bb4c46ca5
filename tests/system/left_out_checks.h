// Checks of what `left_out` lists.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/system/made_scenes.h"
#include "tests/system/report_values.h"

namespace sgs::test {

using Json = nlohmann::json;
using Value = std::function<std::uint64_t(const Json&)>;

// counted: of the frame with the saving and the one without.
using Counted = std::function<std::uint64_t(const Json& with, const Json& without)>;

struct Saving {
  const char* what;
  Counted counted;
  Value work;              // of which there is more without
  std::uint64_t left = 0;  // count where it is not left out
};

// Of a report.
Value region(const char* name);  // bytes read
Value sum(const char* counter);  // over all units
Value of_scene(const char* key);
Value bytes();  // of DRAM
Counted known(std::uint64_t count);

// The same picture with the savings and without, what is left out counted, and more work without.
void check(const std::string& label, const Arguments& saving, const Arguments& off,
           const std::vector<Saving>& rows);

// One in the middle of each group of a diagonal, the others in the dark.
std::vector<Ball> diagonal();
// Five groups whose pixels finish behind the first of many layers, and one where few lie.
GaussianCloud layers();

Arguments plus(Arguments first, const Arguments& second);

}  // namespace sgs::test
