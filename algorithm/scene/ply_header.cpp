// The parser of ply_header.h.
#include "algorithm/scene/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

// Trained scenes have headers of 1.5 KB; the limit keeps a binary file without end_header cheap.
constexpr std::uint64_t kMaxHeaderBytes = 1 << 20;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

std::optional<PlyScalar> scalar_named(std::string_view name) {
  static const std::map<std::string_view, PlyScalar> kTypes = {
      {"char", PlyScalar::kInt8},      {"int8", PlyScalar::kInt8},
      {"uchar", PlyScalar::kUint8},    {"uint8", PlyScalar::kUint8},
      {"short", PlyScalar::kInt16},    {"int16", PlyScalar::kInt16},
      {"ushort", PlyScalar::kUint16},  {"uint16", PlyScalar::kUint16},
      {"int", PlyScalar::kInt32},      {"int32", PlyScalar::kInt32},
      {"uint", PlyScalar::kUint32},    {"uint32", PlyScalar::kUint32},
      {"float", PlyScalar::kFloat32},  {"float32", PlyScalar::kFloat32},
      {"double", PlyScalar::kFloat64}, {"float64", PlyScalar::kFloat64}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) return std::nullopt;
  return found->second;
}

// A word as it may stand in an error message: short and without control characters.
std::string shown(std::string_view text) {
  std::string out(text.substr(0, 60));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

class HeaderParser {
 public:
  explicit HeaderParser(const InputFile& file)
      : file_(file), text_(file.text_from(0, kMaxHeaderBytes)) {}

  PlyHeader parse() {
    if (next_line() != "ply") {
      throw InputError(fmt::format("{}: byte 0: not a PLY file, expected it to begin with \"ply\"",
                                   file_.path()));
    }
    while (true) {
      const std::string_view line = next_line();
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty() || words[0] == "obj_info") continue;
      if (words[0] == "comment") {
        header_.comments.emplace_back(line.substr(line.find("comment") + 7));
        continue;
      }
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        read_format(words, line);
      } else if (words[0] == "element") {
        read_element(words, line);
      } else if (words[0] == "property") {
        read_property(words, line);
      } else {
        fail(line, "format, element, property, comment, obj_info or end_header");
      }
    }
    if (!has_format_) fail("end_header", "a format line before it");
    header_.body_offset_bytes = position_;
    check_counts();
    return header_;
  }

 private:
  [[noreturn]] void fail(std::string_view got, std::string_view expected) const {
    throw InputError(fmt::format("{}: line {}: got \"{}\", expected {}", file_.path(),
                                 header_.line_count, shown(got), expected));
  }

  std::string_view next_line() {
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string::npos) {
      if (header_.line_count == 0) return {};
      throw InputError(
          fmt::format("{}: line {}: the header ends after {} bytes, expected end_header{}",
                      file_.path(), header_.line_count + 1, text_.size(),
                      text_.size() == kMaxHeaderBytes ? " within 1 MiB" : ""));
    }
    std::string_view line(text_.data() + position_, end - position_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    position_ = end + 1;
    ++header_.line_count;
    return line;
  }

  void read_format(const std::vector<std::string_view>& words, std::string_view line) {
    static const std::map<std::string_view, PlyFormat> kFormats = {
        {"ascii", PlyFormat::kAscii},
        {"binary_little_endian", PlyFormat::kBinaryLittleEndian},
        {"binary_big_endian", PlyFormat::kBinaryBigEndian}};
    if (words.size() != 3 || kFormats.count(words[1]) == 0 || words[2] != "1.0" || has_format_) {
      fail(line, "one \"format ascii|binary_little_endian|binary_big_endian 1.0\"");
    }
    header_.format = kFormats.at(words[1]);
    has_format_ = true;
  }

  void read_element(const std::vector<std::string_view>& words, std::string_view line) {
    PlyElement element;
    if (words.size() != 3) fail(line, "\"element NAME COUNT\"");
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc() || stop != end) fail(line, "a count of 0 or more after the name");
    element.name = words[1];
    if (!element_names_.insert(element.name).second) fail(line, "each element once");
    property_names_.clear();
    header_.elements.push_back(element);
  }

  void read_property(const std::vector<std::string_view>& words, std::string_view line) {
    constexpr const char* kForm = "\"property TYPE NAME\" or \"property list TYPE TYPE NAME\"";
    if (header_.elements.empty()) fail(line, "an element line before the first property");
    if (words.size() != 3 && !(words.size() == 5 && words[1] == "list")) fail(line, kForm);
    PlyProperty property;
    property.is_list = words.size() == 5;
    property.name = words.back();
    const auto type = scalar_named(words[words.size() - 2]);
    if (!type) fail(line, "a type from char to double");
    property.type = *type;
    if (property.is_list) {
      const auto count_type = scalar_named(words[2]);
      if (!count_type || *count_type >= PlyScalar::kFloat32) fail(line, "an integer list count");
      property.list_count_type = *count_type;
    }
    if (!property_names_.insert(property.name).second) {
      fail(line, "each property of an element once");
    }
    header_.elements.back().properties.push_back(property);
  }

  // Refuses counts that the rest of the file cannot hold, before anybody allocates for them.
  void check_counts() const {
    std::uint64_t left_bytes = file_.size_bytes() - header_.body_offset_bytes;
    for (const PlyElement& element : header_.elements) {
      if (element.count == 0) continue;
      // In text a value takes at least a digit and a separator.
      const bool ascii = header_.format == PlyFormat::kAscii;
      const std::uint64_t least_bytes =
          ascii ? 2 * element.properties.size() : element.record_bytes();
      if (least_bytes == 0) {
        throw InputError(fmt::format("{}: element {} has no properties, expected at least one",
                                     file_.path(), shown(element.name)));
      }
      const std::uint64_t room = left_bytes / least_bytes;
      if (element.count > room) {
        throw InputError(fmt::format(
            "{}: byte {}: got {} bytes, room for {} records of element {}, expected {} records of "
            "{}{} bytes",
            file_.path(), file_.size_bytes() - left_bytes, left_bytes, room, shown(element.name),
            element.count, ascii || element.has_lists() ? "at least " : "", least_bytes));
      }
      left_bytes -= std::min(left_bytes, element.count * least_bytes);
    }
  }

  const InputFile& file_;
  const std::string text_;
  std::size_t position_ = 0;  // in text_, which begins at byte 0 of the file
  bool has_format_ = false;
  std::set<std::string> element_names_;
  std::set<std::string> property_names_;  // names in the last element
  PlyHeader header_;
};

}  // namespace

std::size_t size_bytes(PlyScalar type) {
  switch (type) {
    case PlyScalar::kInt8:
    case PlyScalar::kUint8:
      return 1;
    case PlyScalar::kInt16:
    case PlyScalar::kUint16:
      return 2;
    case PlyScalar::kInt32:
    case PlyScalar::kUint32:
    case PlyScalar::kFloat32:
      return 4;
    case PlyScalar::kFloat64:
      break;
  }
  return 8;
}

bool PlyElement::has(std::string_view property) const {
  return std::any_of(properties.begin(), properties.end(),
                     [property](const PlyProperty& one) { return one.name == property; });
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.is_list; });
}

std::uint64_t PlyElement::record_bytes() const {
  std::uint64_t sum = 0;
  for (const PlyProperty& property : properties) {
    sum += size_bytes(property.is_list ? property.list_count_type : property.type);
  }
  return sum;
}

const PlyElement* PlyHeader::element(std::string_view name) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(),
                   [name](const PlyElement& element) { return element.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader read_ply_header(const InputFile& file) { return HeaderParser(file).parse(); }

}  // namespace sgs
