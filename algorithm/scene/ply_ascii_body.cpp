// Text records of ply_body.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "algorithm/input_error.h"
#include "algorithm/scene/ply_body.h"

namespace sgs {
namespace {

constexpr const char* kBlanks = " \t\r\v\f";

// Lines of a text with something on them, counted as in the file.
class LineReader {
 public:
  LineReader(const std::string& path, std::string_view text, std::uint64_t lines_before)
      : path_(path), text_(text), line_number_(lines_before) {}

  std::uint64_t line_number() const { return line_number_; }

  bool next(std::string_view& line) {
    while (text_.find_first_not_of(kBlanks) != std::string_view::npos) {
      const std::size_t end = text_.find('\n');
      ++line_number_;
      // A number cut in two is still a number: only the line end shows that the file is whole.
      if (end == std::string_view::npos) {
        throw InputError(fmt::format("{}: line {}: the file ends within the line, expected its end",
                                     path_, line_number_));
      }
      line = text_.substr(0, end);
      text_.remove_prefix(end + 1);
      if (line.find_first_not_of(kBlanks) != std::string_view::npos) return true;
    }
    return false;
  }

 private:
  const std::string& path_;
  std::string_view text_;
  std::uint64_t line_number_;
};

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
}

// Whether all of `word` is a number; `value` is the nearest float, infinite when out of range.
bool parse_float(std::string_view word, float& value) {
  if (!word.empty() && word.front() == '+') {
    word.remove_prefix(1);
    if (!word.empty() && word.front() == '-') return false;
  }
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument || word.empty()) return false;
  // from_chars leaves the value alone where it overflows or underflows; strtof tells which.
  if (error == std::errc::result_out_of_range)
    value = std::strtof(std::string(word).c_str(), nullptr);
  return true;
}

}  // namespace

std::vector<VertexFault> read_ascii_vertices(const InputFile& file, const PlyHeader& header,
                                             std::size_t vertex_element, const VertexLayout& layout,
                                             GaussianCloud& cloud) {
  const std::string text = file.text_from(header.body_offset_bytes, file.size_bytes());
  LineReader lines(file.path(), text, header.line_count);
  std::vector<std::string_view> words;
  std::vector<VertexFault> faults;
  std::array<float, kMaxSlots> slots;
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    for (std::uint64_t record = 0; record < element.count; ++record) {
      std::string_view line;
      if (!lines.next(line)) {
        throw InputError(
            fmt::format("{}: line {}: the file ends after {} records of element {}, expected {}",
                        file.path(), lines.line_number() + 1, record, element.name, element.count));
      }
      if (e != vertex_element) continue;
      split_words(line, words);
      if (words.size() != element.properties.size()) {
        throw InputError(fmt::format("{}: line {}: got {} values, expected {} (vertex {})",
                                     file.path(), lines.line_number(), words.size(),
                                     element.properties.size(), record));
      }
      for (std::size_t slot = 0; slot < layout.columns.size(); ++slot) {
        const std::string_view word = words[layout.columns[slot].property];
        if (!parse_float(word, slots[slot])) {
          throw InputError(fmt::format("{}: line {}: got \"{}\" for {}, expected a number",
                                       file.path(), lines.line_number(), word.substr(0, 40),
                                       slot_name(static_cast<int>(slot))));
        }
      }
      store_vertex(slots.data(), record, cloud, faults);
    }
  }
  if (std::string_view line; lines.next(line)) {
    throw InputError(fmt::format("{}: line {}: got \"{}\" after the last record, expected the end",
                                 file.path(), lines.line_number(), line.substr(0, 40)));
  }
  return faults;
}

}  // namespace sgs
