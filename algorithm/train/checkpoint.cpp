// Magic, version, CRC-32 of what follows, and that by cereal, little-endian.
#include "algorithm/train/checkpoint.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string_view>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/files/output_file.h"
#include "algorithm/train/saved_bytes.h"

namespace sgs {

template <class Archive>
void serialize(Archive& archive, Checkpoint& checkpoint) {
  archive(checkpoint.work, checkpoint.pace, checkpoint.contents, checkpoint.log, checkpoint.seconds,
          checkpoint.state);
}

namespace {

constexpr std::string_view kMagic = "\x89SGSTRAIN\r\n\x1a\n4";

std::uint32_t crc_of(const std::string& text) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

std::string four_bytes(std::uint32_t value) {
  std::string out;
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 0xffU);
  return out;
}

// A reader of what cereal has written, front to back. It would make room for whatever length a text
// states.
class Body {
 public:
  // path: for messages. The first byte says that numbers are little-endian.
  Body(const std::string& path, std::string_view bytes) : path_(path), left_(bytes) { take(1); }

  std::string text() { return std::string(take(number<std::uint64_t>())); }

  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  void expect_end() const {
    if (!left_.empty()) refuse(0);
  }

 private:
  std::string_view take(std::uint64_t bytes) {
    if (bytes > left_.size()) refuse(bytes);
    const std::string_view taken = left_.substr(0, bytes);
    left_.remove_prefix(bytes);
    return taken;
  }
  [[noreturn]] void refuse(std::uint64_t bytes) const {
    throw InputError(
        fmt::format("{}: {} bytes are left of it, expected {}", path_, left_.size(), bytes));
  }

  const std::string& path_;
  std::string_view left_;
};

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  const std::string body = saved_bytes(checkpoint);
  OutputFile file(path);
  file.write(kMagic);
  file.write(four_bytes(crc_of(body)));
  file.write(body);
  file.commit();
}

Checkpoint read_checkpoint(const std::string& path) {
  const InputFile file(path);
  const std::string text = file.text_from(0, file.size_bytes());
  if (text.compare(0, kMagic.size(), kMagic) != 0) {
    throw InputError(
        fmt::format("{}: begins with something else, expected a checkpoint of streaminggs train "
                    "or tune",
                    path));
  }
  const std::string crc = text.substr(kMagic.size(), 4);
  const std::string body = text.substr(kMagic.size() + crc.size());
  if (crc != four_bytes(crc_of(body))) {
    throw InputError(path + ": was cut off or changed, its checksum is another");
  }
  Checkpoint checkpoint;
  Body fields(path, body);
  checkpoint.work = fields.text();
  checkpoint.pace = fields.text();
  checkpoint.contents = fields.text();
  checkpoint.log = fields.text();
  checkpoint.seconds = fields.number<double>();
  checkpoint.state = fields.text();
  fields.expect_end();
  return checkpoint;
}

}  // namespace sgs
