// Messages are one line, whatever is put into them.
#include "algorithm/files/input_error.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace sgs;

TEST_CASE("messages: control characters and broken UTF-8 are escaped, all else stays") {
  struct Row {
    std::string_view text, shown;
  };
  for (const Row& row :
       std::vector<Row>{{"plain \\ 'text'", "plain \\ 'text'"},
                        {"two\nlines\r\n", "two\\nlines\\x0d\\n"},
                        {"a\tb", "a\\tb"},
                        {"\x1b[31mred\x1b[0m", "\\x1b[31mred\\x1b[0m"},
                        {std::string_view("a\0b\x7f", 4), "a\\x00b\\x7f"},
                        {"gr\xc3\xbc\xc3\x9f", "gr\xc3\xbc\xc3\x9f"},
                        {"\xe2\x82\xac \xf0\x9f\x8c\xb2", "\xe2\x82\xac \xf0\x9f\x8c\xb2"},
                        {"\xc3", "\\xc3"},
                        {"\xe2\x82", "\\xe2\\x82"},
                        {"\xff\x80", "\\xff\\x80"},
                        {"\xc2\x9b", "\\xc2\\x9b"},
                        {"", ""}}) {
    CHECK(one_line(row.text) == row.shown);
    CHECK(std::string(InputError(row.text).what()) == row.shown);
  }
}

TEST_CASE("messages: of a long one the beginning and the end are left") {
  const std::string value(1 << 20, 'v');
  const std::string shown = one_line("file.json: key: got " + value + ", expected less");
  CHECK(shown.size() < 2000);
  CHECK(shown.find("file.json: key: got vvv") == 0);
  CHECK(shown.find("bytes left out") != std::string::npos);
  CHECK(shown.rfind("vvv, expected less") == shown.size() - 18);
  CHECK(one_line(std::string(kMostMessageBytes, 'v')) == std::string(kMostMessageBytes, 'v'));
}
