// Words and numbers of a text, one after the other.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sgs {

// True for a number as from_chars() reads it, also one that is not finite.
bool is_number(std::string_view text);

// Fields are separated by white space. All functions throw InputError that begins with `where`.
class TextFields {
 public:
  // `text` must outlive it. where: file and line, for messages.
  TextFields(std::string_view text, std::string where);

  bool at_end() const { return text_.empty(); }
  // what: what is expected, for messages.
  std::string_view word(const char* what);
  double number(const char* what);      // finite
  double any_number(const char* what);  // also inf and nan
  std::uint64_t whole_number(const char* what, std::uint64_t most);
  // Everything that is left, without white space around it.
  std::string_view rest(const char* what);
  void expect_end() const;

 private:
  void skip_space();

  std::string_view text_;  // begins with a field
  std::string where_;
};

}  // namespace sgs
