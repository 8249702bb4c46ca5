// The error that every reader of files, arguments and configurations throws on input that it cannot
// use, and how its message is put together.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace sgs {

// `text` as it may reach a terminal: control characters and bytes that are no UTF-8 as \n, \x1b,
// ..., and only the beginning and the end of what is longer than kMostMessageBytes.
std::string one_line(std::string_view text);
constexpr std::size_t kMostMessageBytes = 2000;

// The message is one line: file, place (offset, line, property or key), what was found, what was
// expected. Values may be put into it as they were found: it goes through one_line(). The
// executables print it and end with exit status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::string_view message) : std::runtime_error(one_line(message)) {}
};

// "a, b, c" of anything that holds strings. (fmt::join draws a false overflow warning from gcc 12.)
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
