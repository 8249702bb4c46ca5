#include "tests/system/error_line.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/system/shell.h"

namespace sgs::test {
namespace {

std::size_t lines_without_notes(const std::string& text) {
  std::istringstream lines(text);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) {
    count += line.find(": note: ") == std::string::npos ? 1 : 0;
  }
  return count;
}

std::set<std::string> files_in(const ScratchFolder& scratch) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch.path(""))) {
    const bool regular = entry.is_regular_file() && !entry.is_symlink();
    files.insert(entry.path().string() + (regular ? bytes_of(entry.path().string()) : ""));
  }
  return files;
}

}  // namespace

void check(const ErrorLine& row) {
  INFO(row.line);
  const ScratchFolder scratch;
  if (!row.before.empty()) REQUIRE(shell(scratch, row.before).status == 0);
  const auto before = files_in(scratch);
  const ShellOutcome outcome = shell(scratch, row.line);
  INFO(outcome.err.substr(0, 3000));
  CHECK(outcome.status == row.status);
  CHECK(lines_without_notes(outcome.err) == 1);
  CHECK(outcome.err.size() < 7000);
  const bool named =
      outcome.err.rfind("streaminggs: ", 0) == 0 || outcome.err.rfind("tb_dram: ", 0) == 0;
  CHECK(named);
  for (const char c : outcome.err) CHECK((c == '\n' || static_cast<unsigned char>(c) >= ' '));
  for (const std::string& word : row.words) {
    INFO(word);
    CHECK(outcome.err.find(word) != std::string::npos);
  }
  CHECK((files_in(scratch) == before));
}

}  // namespace sgs::test
