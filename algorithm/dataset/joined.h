// Words for messages. (fmt::join draws a false overflow warning from gcc 12.)
#pragma once

#include <string>
#include <vector>

namespace sgs {

inline std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += between;
    text += word;
  }
  return text;
}

}  // namespace sgs
