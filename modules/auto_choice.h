// A choice that the configuration left to the model.
#pragma once

#include <string>

namespace sgs {

struct AutoChoice {
  std::string key;
  double value = 0;
  std::string why;  // a sentence with the numbers
};

}  // namespace sgs
