// Binary records of ply_body.h: blocks are read and converted in parallel.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "algorithm/input_error.h"
#include "algorithm/scene/ply_body.h"
#include "algorithm/scene/ply_scalar.h"

namespace sgs {
namespace {

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
                                     std::uint64_t record_bytes, const Decode& decode,
                                     GaussianCloud& cloud) {
  const std::uint64_t block_records = std::max<std::uint64_t>(1, kBlockBytes / record_bytes);
  const std::uint64_t blocks = (cloud.size() + block_records - 1) / block_records;
  std::vector<std::vector<VertexFault>> faults(blocks);
  tbb::parallel_for(std::uint64_t{0}, blocks, [&](std::uint64_t block) {
    const std::uint64_t begin = block * block_records;
    const std::uint64_t end = std::min<std::uint64_t>(cloud.size(), begin + block_records);
    std::vector<char> records((end - begin) * record_bytes);
    file.read_at(offset_bytes + begin * record_bytes, records.data(), records.size());
    std::array<float, kMaxSlots> slots;
    for (std::uint64_t i = begin; i < end; ++i) {
      decode(&records[(i - begin) * record_bytes], slots.data());
      store_vertex(slots.data(), i, cloud, faults[block]);
    }
  });
  std::vector<VertexFault> all;
  for (const auto& some : faults) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace

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
        file, vertex_offset_bytes, layout.record_bytes,
        [&columns](const char* record, float* slots) {
          for (const auto& column : columns) {
            std::memcpy(slots++, record + column.offset_bytes, sizeof(float));
          }
        },
        cloud);
  }
  return read_blocks(
      file, vertex_offset_bytes, layout.record_bytes,
      [&columns, format = header.format](const char* record, float* slots) {
        for (const auto& column : columns) {
          *slots++ = load_ply_scalar<float>(format, record + column.offset_bytes, column.type);
        }
      },
      cloud);
}

}  // namespace sgs
