// Text records one after the other; binary records in blocks, read and converted in parallel.
#include "algorithm/scene/ply_reader.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {
namespace {

constexpr const char* kBlanks = " \t\r\v\f";
constexpr std::size_t kMaxColumns = kFilterSlot + 1;

// Lines of a text with something on them, counted as in the file.
class RecordLines {
 public:
  RecordLines(const std::string& path, std::string_view text, std::uint64_t lines_before)
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

// True if all of `word` is a number; `value` is the nearest float, infinite when out of range.
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

// slots: one a column.
void store_row(const VertexLayout& layout, float* slots, std::uint64_t index, GaussianCloud& cloud,
               std::vector<VertexFault>& faults) {
  if (layout.has_filter) {
    const float filter = slots[layout.columns.size() - 1];
    if (!(std::abs(filter) <= static_cast<float>(kMaxScale))) {
      faults.push_back({index, kFilterSlot, filter});
      return;
    }
    bake_filter(filter, slots);
  }
  store_vertex(slots, index, cloud, faults);
}

// Both fill `cloud`, already resized to the count of element number `vertex_element` of `header`,
// and return the vertices that cannot be used, ascending. They throw InputError when the file ends
// before the last record of any element, with a record that cannot be read, or goes on behind it.

// One record a line, values separated by blanks; empty lines are skipped.
std::vector<VertexFault> read_ascii_vertices(const InputFile& file, const PlyHeader& header,
                                             std::size_t vertex_element, const VertexLayout& layout,
                                             GaussianCloud& cloud) {
  const std::string text = file.text_from(header.body_offset_bytes, file.size_bytes());
  RecordLines lines(file.path(), text, header.line_count);
  std::vector<std::string_view> words;
  std::vector<VertexFault> faults;
  std::array<float, kMaxColumns> slots;
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
                                       element.properties[layout.columns[slot].property].name));
        }
      }
      store_row(layout, slots.data(), record, cloud, faults);
    }
  }
  if (std::string_view line; lines.next(line)) {
    throw InputError(fmt::format("{}: line {}: got \"{}\" after the last record, expected the end",
                                 file.path(), lines.line_number(), line.substr(0, 40)));
  }
  return faults;
}

constexpr std::uint64_t kBlockBytes = 1 << 19;  // a block stays in the second-level cache

// A window on the file that moves forward: lists make record sizes known only one by one.
class ForwardReader {
 public:
  ForwardReader(const InputFile& file, std::uint64_t offset_bytes)
      : file_(file), offset_bytes_(offset_bytes) {}

  std::uint64_t offset_bytes() const { return offset_bytes_; }

  const char* take(std::size_t size) {
    if (offset_bytes_ < begin_bytes_ || offset_bytes_ + size > begin_bytes_ + window_.size()) {
      begin_bytes_ = offset_bytes_;
      window_ = file_.text_from(offset_bytes_, kBlockBytes);
      if (window_.size() < size) file_.read_at(offset_bytes_, window_.data(), size);
    }
    const char* at = window_.data() + (offset_bytes_ - begin_bytes_);
    offset_bytes_ += size;
    return at;
  }

  // Refuses to pass the end, so that a wrong count cannot wrap around.
  void skip(std::uint64_t count, std::uint64_t size) {
    const std::uint64_t left = file_.size_bytes() - offset_bytes_;
    if (size != 0 && count > left / size) {
      throw InputError(
          fmt::format("{}: byte {}: the file ends after {} bytes, expected {} values of {} bytes",
                      file_.path(), offset_bytes_, left, count, size));
    }
    offset_bytes_ += count * size;
  }

 private:
  const InputFile& file_;
  std::uint64_t offset_bytes_;
  std::uint64_t begin_bytes_ = 0;
  std::string window_;
};

void skip_element(const InputFile& file, PlyFormat format, const PlyElement& element,
                  ForwardReader& reader) {
  if (!element.has_lists()) {
    reader.skip(element.count, element.record_bytes());
    return;
  }
  for (std::uint64_t record = 0; record < element.count; ++record) {
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        reader.skip(1, size_bytes(property.type));
        continue;
      }
      const std::uint64_t at_bytes = reader.offset_bytes();
      const auto length = load_ply_scalar<std::int64_t>(
          format, reader.take(size_bytes(property.list_count_type)), property.list_count_type);
      if (length < 0) {
        throw InputError(
            fmt::format("{}: byte {}: element {}, list {}: got length {}, expected 0 or more",
                        file.path(), at_bytes, element.name, property.name, length));
      }
      reader.skip(static_cast<std::uint64_t>(length), size_bytes(property.type));
    }
  }
}

// Converts all vertices with `decode(record, slots)`, blocks in parallel.
template <typename Decode>
std::vector<VertexFault> read_blocks(const InputFile& file, std::uint64_t offset_bytes,
                                     const VertexLayout& layout, const Decode& decode,
                                     GaussianCloud& cloud) {
  const std::uint64_t record_bytes = layout.record_bytes;
  const std::uint64_t block_records = std::max<std::uint64_t>(1, kBlockBytes / record_bytes);
  const std::uint64_t blocks = (cloud.size() + block_records - 1) / block_records;
  std::vector<std::vector<VertexFault>> faults(blocks);
  tbb::parallel_for(std::uint64_t{0}, blocks, [&](std::uint64_t block) {
    const std::uint64_t begin = block * block_records;
    const std::uint64_t end = std::min<std::uint64_t>(cloud.size(), begin + block_records);
    std::vector<char> records((end - begin) * record_bytes);
    file.read_at(offset_bytes + begin * record_bytes, records.data(), records.size());
    std::array<float, kMaxColumns> slots;
    for (std::uint64_t i = begin; i < end; ++i) {
      decode(&records[(i - begin) * record_bytes], slots.data());
      store_row(layout, slots.data(), i, cloud, faults[block]);
    }
  });
  std::vector<VertexFault> all;
  for (const auto& some : faults) all.insert(all.end(), some.begin(), some.end());
  return all;
}

// Runs on all threads; binary of either byte order.
std::vector<VertexFault> read_binary_vertices(const InputFile& file, const PlyHeader& header,
                                              std::size_t vertex_element,
                                              const VertexLayout& layout, GaussianCloud& cloud) {
  ForwardReader reader(file, header.body_offset_bytes);
  std::uint64_t vertex_offset_bytes = 0;
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    if (i == vertex_element) vertex_offset_bytes = reader.offset_bytes();
    skip_element(file, header.format, header.elements[i], reader);
  }
  if (reader.offset_bytes() != file.size_bytes()) {
    throw InputError(
        fmt::format("{}: byte {}: got {} bytes after the last record, expected the end of the file",
                    file.path(), reader.offset_bytes(), file.size_bytes() - reader.offset_bytes()));
  }

  const std::vector<VertexLayout::Column>& columns = layout.columns;
  const bool plain_floats =
      header.format == PlyFormat::kBinaryLittleEndian &&
      std::all_of(columns.begin(), columns.end(), [](const VertexLayout::Column& column) {
        return column.type == PlyScalar::kFloat32;
      });
  if (plain_floats) {
    return read_blocks(
        file, vertex_offset_bytes, layout,
        [&columns](const char* record, float* slots) {
          for (const auto& column : columns) {
            std::memcpy(slots++, record + column.offset_bytes, sizeof(float));
          }
        },
        cloud);
  }
  return read_blocks(
      file, vertex_offset_bytes, layout,
      [&columns, format = header.format](const char* record, float* slots) {
        for (const auto& column : columns) {
          *slots++ = load_ply_scalar<float>(format, record + column.offset_bytes, column.type);
        }
      },
      cloud);
}

// Properties that are read, and those that mean nothing in the files of the original.
std::set<std::string> names_of(const VertexLayout& layout) {
  std::set<std::string> names = {"nx", "ny", "nz"};
  if (layout.has_filter) names.insert(kFilterProperty);
  for (int slot = 0; slot < kRestSlot + 3 * (sh_coeff_count(layout.sh_degree) - 1); ++slot) {
    names.insert(slot_name(slot));
  }
  return names;
}

}  // namespace

SceneContents read_ply(const std::string& path, const SceneReadOptions& options) {
  const InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  const PlyElement* const vertex = header.element("vertex");
  if (vertex == nullptr) {
    throw InputError(fmt::format("{}: line {}: the header has no element vertex, expected one",
                                 path, header.line_count));
  }
  refuse_other_kinds(path, header);
  const VertexLayout layout = layout_of_vertex(path, *vertex);

  SceneContents result;
  result.notes = notes_on_ply(header, {{"vertex", names_of(layout)}});
  result.cloud.resize(vertex->count, layout.sh_degree);
  const auto read_vertices =
      header.format == PlyFormat::kAscii ? read_ascii_vertices : read_binary_vertices;
  const auto vertex_element = static_cast<std::size_t>(vertex - header.elements.data());
  const std::vector<VertexFault> faults =
      read_vertices(file, header, vertex_element, layout, result.cloud);
  settle_faults(path, faults, options, result);
  return result;
}

}  // namespace sgs
