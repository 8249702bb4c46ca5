// Magic, version, CRC-32 of what follows, and that by cereal, little-endian.
#include "algorithm/train/checkpoint.h"

#include <fmt/format.h>
#include <zlib.h>

#include "algorithm/input_error.h"
#include "algorithm/input_file.h"
#include "algorithm/output_file.h"
#include "algorithm/train/saved_bytes.h"

namespace sgs {

template <class Archive>
void serialize(Archive& archive, Checkpoint& checkpoint) {
  archive(checkpoint.work, checkpoint.contents, checkpoint.log, checkpoint.seconds,
          checkpoint.state);
}

namespace {

constexpr std::string_view kMagic = "\x89SGSTRAIN\r\n\x1a\n3";

std::uint32_t crc_of(const std::string& text) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

std::string four_bytes(std::uint32_t value) {
  std::string out;
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 0xffU);
  return out;
}

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
  restore_bytes(body, checkpoint);
  return checkpoint;
}

}  // namespace sgs
