// A choice that the configuration left to the model.
//
// What is decided is decided once, for the scene, its frames or the memory that was given: it stays
// when another key changes. What is derived follows from other keys, and is made anew.
#pragma once

#include <string>

namespace sgs {

enum class ChoiceKind { kDecided, kDerived };

struct AutoChoice {
  ChoiceKind kind = ChoiceKind::kDerived;
  std::string key;
  double value = 0;
  std::string why;  // a sentence with the numbers
};

}  // namespace sgs
