// SpzHeader, streams and numbers of spz_file.h.
#include "algorithm/scene_files/spz_file.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_kinds.h"
#include "algorithm/scene_files/compressed_bytes.h"
#include "algorithm/scene_files/decoded_scene.h"

namespace sgs {
namespace {

constexpr std::uint64_t kSpzHeaderBytes = 16, kZstdHeaderBytes = 32, kTocEntryBytes = 16;
constexpr std::uint32_t kMagic = 0x5053474e;  // NGSP
constexpr std::uint32_t kZstdVersion = 4;     // the first with zstd streams
constexpr std::uint8_t kAntialiasedFlag = 1;
constexpr int kMostFractionalBits = 24;

struct SpzHeader {
  std::uint32_t version = 0, count = 0;
  int degree = 0, fractional_bits = 0;
  bool antialiased = false;
};

// Throws InputError for what is none.
SpzHeader header_of(const std::string& origin, std::string_view bytes) {
  const auto refuse = [&](const std::string& got, const char* expected) {
    throw InputError(fmt::format("{}: got {}, expected {}", origin, got, expected));
  };
  if (bytes.size() < kSpzHeaderBytes) {
    refuse(fmt::format("{} bytes", bytes.size()), "the 16 bytes of a header of .spz");
  }
  if (load_number<std::uint32_t>(&bytes[0]) != kMagic) {
    refuse(fmt::format("a header that begins with {:#010x}", load_number<std::uint32_t>(&bytes[0])),
           "NGSP, as .spz begins");
  }
  SpzHeader header;
  header.version = load_number<std::uint32_t>(&bytes[4]);
  header.count = load_number<std::uint32_t>(&bytes[8]);
  header.degree = byte_at(&bytes[12]);
  header.fractional_bits = byte_at(&bytes[13]);
  header.antialiased = (byte_at(&bytes[14]) & kAntialiasedFlag) != 0;
  if (header.version < 1 || header.version > kZstdVersion) {
    refuse(fmt::format("version {} of .spz", header.version), "1 to 4");
  }
  if (header.degree > 3) {
    refuse(fmt::format("SH degree {}", header.degree),
           "0 to 3: pack the scene again with at most that degree");
  }
  if (header.fractional_bits > kMostFractionalBits) {
    refuse(fmt::format("{} fractional bits", header.fractional_bits), "at most 24");
  }
  return header;
}

// Bytes of a Gaussian in each stream.
struct Strides {
  std::array<std::uint64_t, 6> bytes;  // centre, opacity, colour, scale, rotation, SH

  explicit Strides(const SpzHeader& header)
      : bytes{header.version == 1 ? 6U : 9U,
              1,
              3,
              3,
              header.version < 3 ? 3U : 4U,
              3 * static_cast<std::uint64_t>(rest_coeff_count(header.degree))} {}
  std::uint64_t sum() const {
    std::uint64_t all = 0;
    for (const std::uint64_t one : bytes) all += one;
    return all;
  }
};

// The streams, each of `count` times its stride.
struct Streams {
  std::array<std::string, 6> bytes;
};

Streams split(const SpzHeader& header, std::string_view body) {
  Streams streams;
  const Strides strides(header);
  for (std::size_t i = 0; i < strides.bytes.size(); ++i) {
    const std::uint64_t size = header.count * strides.bytes[i];
    streams.bytes[i] = body.substr(0, size);
    body.remove_prefix(size);
  }
  return streams;
}

Streams zstd_streams(const std::string& origin, const SpzHeader& header, std::string_view bytes) {
  const auto check = [&](bool holds, const std::string& got, const std::string& expected) {
    if (!holds) throw InputError(fmt::format("{}: got {}, expected {}", origin, got, expected));
  };
  check(bytes.size() >= kZstdHeaderBytes, fmt::format("{} bytes", bytes.size()),
        "the 32 bytes of a header of .spz, version 4");
  const std::uint64_t count = byte_at(&bytes[15]);
  const std::uint64_t toc = load_number<std::uint32_t>(&bytes[16]);
  const std::uint64_t expected = header.degree == 0 ? 5 : 6;
  check(count == expected, fmt::format("{} streams", count), std::to_string(expected));
  check(toc >= kZstdHeaderBytes && toc + count * kTocEntryBytes <= bytes.size(),
        fmt::format("a table of streams at byte {} of {}", toc, bytes.size()),
        "it behind the header and within the file");
  Streams streams;
  const Strides strides(header);
  std::uint64_t begin = toc + count * kTocEntryBytes;
  for (std::size_t i = 0; i < count; ++i) {
    const char* entry = &bytes[toc + i * kTocEntryBytes];
    const auto packed = load_number<std::uint64_t>(entry);
    const auto size = load_number<std::uint64_t>(entry + 8);
    const std::uint64_t needed = header.count * strides.bytes[i];
    check(size == needed, fmt::format("stream {} of {} bytes", i, size),
          fmt::format("{} for {} Gaussians", needed, header.count));
    check(packed <= bytes.size() - begin,
          fmt::format("stream {} of {} compressed bytes at byte {}", i, packed, begin),
          fmt::format("at most {}", bytes.size() - begin));
    streams.bytes[i] =
        unzstd(fmt::format("{}: stream {}", origin, i), bytes.substr(begin, packed), size);
    begin += packed;
  }
  check(begin == bytes.size(), fmt::format("{} bytes behind the last stream", bytes.size() - begin),
        "the end of the file");
  return streams;
}

float fixed_point(const char* bytes, double unit) {
  const std::uint32_t raw = static_cast<std::uint32_t>(byte_at(bytes)) |
                            static_cast<std::uint32_t>(byte_at(bytes + 1)) << 8 |
                            static_cast<std::uint32_t>(byte_at(bytes + 2)) << 16;
  const int value =
      (raw & 0x800000U) != 0 ? static_cast<int>(raw) - (1 << 24) : static_cast<int>(raw);
  return static_cast<float>(value * unit);
}

// Three components of 8 bits each; the first one, w, follows.
void decode_first_three(const char* bytes, float* rotation) {
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double part = byte_at(bytes + k) / 127.5 - 1.0;
    rotation[k + 1] = static_cast<float>(part);
    squared += part * part;
  }
  rotation[0] = static_cast<float>(std::sqrt(std::max(0.0, 1.0 - squared)));
}

// The three smaller ones in sign and 9 bits each; the largest, named by two bits, follows.
void decode_smallest_three(std::uint32_t word, float* rotation) {
  constexpr std::uint32_t kMost = (1U << 9) - 1;
  const std::uint32_t largest = word >> 30;
  std::array<double, 4> xyzw{};
  double squared = 0;
  for (std::uint32_t k = 4; k-- > 0;) {
    if (k == largest) continue;
    const double part = std::sqrt(0.5) * (word & kMost) / kMost;
    xyzw[k] = ((word >> 9) & 1) != 0 ? -part : part;
    squared += part * part;
    word >>= 10;
  }
  xyzw[largest] = std::sqrt(std::max(0.0, 1.0 - squared));
  for (int k = 0; k < 4; ++k) rotation[k] = static_cast<float>(xyzw[(k + 3) % 4]);
}

}  // namespace

SceneContents read_spz_bytes(const std::string& origin, std::string_view bytes,
                             const SceneReadOptions& options) {
  const bool is_gzip = bytes.substr(0, 2) == "\x1f\x8b";
  const SpzHeader header =
      header_of(origin, is_gzip ? gunzipped_start(origin, bytes, kSpzHeaderBytes)
                                : std::string(bytes.substr(0, kSpzHeaderBytes)));
  Streams streams;
  if (header.version == kZstdVersion) {
    if (is_gzip)
      throw InputError(fmt::format("{}: got .spz, version 4, in gzip, expected it bare", origin));
    streams = zstd_streams(origin, header, bytes);
  } else {
    const std::uint64_t size = kSpzHeaderBytes + header.count * Strides(header).sum();
    std::string unpacked;
    if (is_gzip) {
      unpacked = gunzipped(origin, bytes, size);
      bytes = unpacked;
    }
    if (bytes.size() != size) {
      throw InputError(fmt::format("{}: got {} bytes, expected {} for {} Gaussians", origin,
                                   bytes.size(), size, header.count));
    }
    streams = split(header, bytes.substr(kSpzHeaderBytes));
  }

  const Strides strides(header);
  const double unit = 1.0 / (1 << header.fractional_bits);
  const int rest = rest_coeff_count(header.degree);
  SceneContents contents = decoded_scene(
      origin, header.count, header.degree, options, [&](std::uint64_t index, float* slots) {
        const auto record = [&](std::size_t stream) {
          return &streams.bytes[stream][index * strides.bytes[stream]];
        };
        const char *centre = record(0), *colour = record(2), *scale = record(3);
        for (int i = 0; i < 3; ++i) {
          slots[kMeanSlot + i] =
              header.version == 1 ? half_at(centre + 2 * i) : fixed_point(centre + 3 * i, unit);
          slots[kDcSlot + i] = static_cast<float>((byte_at(colour + i) / 255.0 - 0.5) / 0.15);
          slots[kScaleSlot + i] = static_cast<float>(byte_at(scale + i) / 16.0 - 10.0);
        }
        slots[kOpacitySlot] = logit_of_byte(byte_at(record(1)));
        if (header.version < 3) {
          decode_first_three(record(4), slots + kRotationSlot);
        } else {
          decode_smallest_three(load_number<std::uint32_t>(record(4)), slots + kRotationSlot);
        }
        for (int k = 0; k < rest; ++k) {
          for (int channel = 0; channel < 3; ++channel) {
            const int byte = byte_at(record(5) + 3 * k + channel);
            slots[rest_slot(header.degree, channel, k)] = static_cast<float>((byte - 128) / 128.0);
          }
        }
      });
  if (header.antialiased) contents.notes.emplace_back(kAntialiasedNote);
  return contents;
}

SceneContents read_spz(const std::string& path, const SceneReadOptions& options) {
  const InputFile file(path);
  return read_spz_bytes(path, file.text_from(0, file.size_bytes()), options);
}

}  // namespace sgs
