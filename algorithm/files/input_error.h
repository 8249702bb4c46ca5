// The error that every reader of files, arguments and configurations raises, and the name that a
// misspelt word most likely means.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

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

// The name that a misspelt word most likely means.

// Place of the name that the fewest insertions, deletions, exchanges and swaps of neighbours make
// of `word`; the first of several. None where that takes more than a third of its letters.
std::optional<std::size_t> nearest_name(const std::string& word,
                                        const std::vector<std::string>& names);

// The same among paths of keys, "sram.input_bytes", by their last keys; of several as near, that
// with the nearest path.
std::optional<std::size_t> nearest_key(const std::string& key,
                                       const std::vector<std::string>& paths);

// "; did you mean exact?", behind what was got; empty where no name is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names);

// The same, and the words that lead to what is allowed: a long list comes behind the question.
std::string then_expected(const std::string& question);

}  // namespace sgs
