// Words for messages. (fmt::join draws a false overflow warning from gcc 12.)
#pragma once

#include <string>

namespace sgs {

// "a, b, c" of anything that holds strings.
template <class Container>
std::string join(const Container& words, const char* between = ", ") {
  std::string text;
  for (const auto& word : words) {
    if (&word != &*words.begin()) text += between;
    text += word;
  }
  return text;
}

}  // namespace sgs
