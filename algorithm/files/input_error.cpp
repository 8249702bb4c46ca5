// The words of refusals.
#include "algorithm/files/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace sgs {

namespace {

// Bytes of the UTF-8 character that `text` begins with; 0 for what is none or controls a terminal.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // U+0080 to U+009F are control characters of their own.
  return first == 0xc2 && byte(1) < 0xa0 ? 0 : bytes;
}

void append_escaped(std::string_view text, std::string& out) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes > 0) {
      out += text.substr(0, bytes);
      text.remove_prefix(bytes);
      continue;
    }
    switch (const char byte = text.front()) {
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        out += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(byte));
    }
    text.remove_prefix(1);
  }
}

// Of optimal string alignment: no piece is edited twice.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = last;
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t exchange = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, exchange});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string last_key(const std::string& path) { return path.substr(path.rfind('.') + 1); }

constexpr std::size_t kLongestName = 100;  // what is longer means no name

// The most edits of a word that may still mean a name.
std::size_t most_edits(const std::string& word) { return (word.size() + 1) / 3; }

}  // namespace

std::string one_line(std::string_view text) {
  std::string out;
  if (text.size() <= kMostMessageBytes) {
    append_escaped(text, out);
    return out;
  }
  constexpr std::size_t kHead = kMostMessageBytes / 2, kTail = kMostMessageBytes / 4;
  append_escaped(text.substr(0, kHead), out);
  out += fmt::format(" ... ({} bytes left out) ... ", text.size() - kHead - kTail);
  append_escaped(text.substr(text.size() - kTail), out);
  return out;
}

std::optional<std::size_t> nearest_name(const std::string& word,
                                        const std::vector<std::string>& names) {
  std::optional<std::size_t> nearest;
  std::size_t fewest = most_edits(word) + 1;
  if (word.size() > kLongestName) return {};
  for (std::size_t at = 0; at < names.size(); ++at) {
    const std::size_t edits = edit_distance(word, names[at]);
    if (edits >= fewest) continue;
    nearest = at;
    fewest = edits;
  }
  return nearest;
}

std::optional<std::size_t> nearest_key(const std::string& key,
                                       const std::vector<std::string>& paths) {
  std::optional<std::size_t> nearest;
  std::pair<std::size_t, std::size_t> fewest(most_edits(last_key(key)) + 1, 0);
  if (key.size() > kLongestName) return {};
  for (std::size_t at = 0; at < paths.size(); ++at) {
    const std::size_t edits = edit_distance(last_key(key), last_key(paths[at]));
    if (edits > fewest.first) continue;
    const std::pair both(edits, edit_distance(key, paths[at]));
    if (both >= fewest) continue;
    nearest = at;
    fewest = both;
  }
  return nearest;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  const auto nearest = nearest_name(word, names);
  return nearest ? "; did you mean " + names[*nearest] + "?" : "";
}

std::string then_expected(const std::string& question) {
  return question.empty() ? ", expected " : question + " Expected ";
}

}  // namespace sgs
