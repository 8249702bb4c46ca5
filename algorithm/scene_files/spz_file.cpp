// Header, extensions, streams and numbers of .spz (scene_forms.h).
#include <fmt/format.h>

#include <numeric>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_header.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/scene_forms.h"
#include "algorithm/scene_files/stored_bytes.h"

namespace sgs {
namespace {

constexpr std::uint64_t kSpzHeaderBytes = 16, kZstdHeaderBytes = 32, kTocEntryBytes = 16;
constexpr std::uint32_t kMagic = 0x5053474e;  // NGSP
constexpr std::uint32_t kZstdVersion = 4;     // the first with zstd streams
constexpr std::uint8_t kAntialiasedFlag = 1, kExtensionsFlag = 2;
constexpr std::uint64_t kMostExtensionBytes = 1 << 16;  // of all together
constexpr int kMostFractionalBits = 24;

struct SpzHeader {
  std::uint32_t version = 0, count = 0;
  int degree = 0, fractional_bits = 0;
  bool antialiased = false, has_extensions = false;
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
  const std::uint8_t flags = byte_at(&bytes[14]);
  header.antialiased = (flags & kAntialiasedFlag) != 0;
  header.has_extensions = (flags & kExtensionsFlag) != 0;
  if (header.version < 1 || header.version > kZstdVersion) {
    refuse(fmt::format("version {} of .spz", header.version), "1 to 4");
  }
  if ((flags & ~(kAntialiasedFlag | kExtensionsFlag)) != 0) {
    refuse(fmt::format("the flags {:#04x}", flags),
           "0x01 for anti-aliased and 0x02 for extensions alone: others change what is drawn");
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
    return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
  }
};

// The streams, each of `count` times its stride, and the records of extensions.
struct Streams {
  std::array<std::string, 6> bytes;
  std::string extensions;
};

Streams split(const SpzHeader& header, std::string_view body) {
  Streams streams;
  const Strides strides(header);
  for (std::size_t i = 0; i < strides.bytes.size(); ++i) {
    const std::uint64_t size = header.count * strides.bytes[i];
    streams.bytes[i] = body.substr(0, size);
    body.remove_prefix(size);
  }
  streams.extensions = body;
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
  check(toc == kZstdHeaderBytes || header.has_extensions,
        fmt::format("{} bytes before the table of streams", toc - kZstdHeaderBytes),
        "none without the flag of extensions");
  Streams streams;
  streams.extensions = bytes.substr(kZstdHeaderBytes, toc - kZstdHeaderBytes);
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

// Three components of 8 bits each; w, not the largest, follows.
void decode_first_three(const char* bytes, float* rotation) {
  decode_smallest_three(
      {0, 1, 2, 3}, 0, [&] { return byte_at(bytes++) / 127.5 - 1.0; }, rotation);
}

// The three smaller ones in sign and 9 bits each, from w to x; the largest of x y z w, named by two
// bits, follows.
void decode_signed_three(std::uint32_t word, float* rotation) {
  constexpr std::uint32_t kMost = (1U << 9) - 1;
  const auto largest = static_cast<int>(word >> 30);
  const auto next = [&] {
    const double part = std::sqrt(0.5) * (word & kMost) / kMost;
    const bool negative = ((word >> 9) & 1) != 0;
    word >>= 10;
    return negative ? -part : part;
  };
  decode_smallest_three({0, 3, 2, 1}, (largest + 1) % 4, next, rotation);
}

// Reads records of a type, a length and as many bytes.
void read_extensions(const std::string& origin, std::string_view records, SceneContents& contents) {
  constexpr std::uint32_t kSafeOrbitCamera = 0xadbe0002, kCoordinateSystem = 0xadbe0003;
  // By the numbers of the extension's CoordinateSystem; f is front.
  constexpr const char* kSystems[] = {"",    "ldb", "rdb", "lub", "rub", "ldf", "rdf", "luf", "ruf",
                                      "lfd", "rfd", "lfu", "rfu", "lbd", "rbd", "lbu", "rbu"};
  while (!records.empty()) {
    const std::uint64_t size = records.size() < 8 ? 0 : load_number<std::uint32_t>(&records[4]);
    if (records.size() < 8 || size > records.size() - 8) {
      throw InputError(fmt::format("{}: got an extension of {} bytes in {}, expected whole ones",
                                   origin, size, records.size()));
    }
    const auto type = load_number<std::uint32_t>(&records[0]);
    const std::string_view body = records.substr(8, size);
    records.remove_prefix(8 + size);
    if (type == kSafeOrbitCamera) {
      contents.notes.emplace_back("limits for a viewer's camera are skipped");
    } else if (type != kCoordinateSystem) {
      contents.notes.push_back(
          fmt::format("extension {:#010x} of {} bytes is not known here and skipped", type, size));
    } else {
      const std::uint32_t system = size == 4 ? load_number<std::uint32_t>(body.data()) : 0;
      if (system < 1 || system >= std::size(kSystems)) {
        throw InputError(fmt::format("{}: got coordinate system {} in {} bytes, expected 1 to 16",
                                     origin, system, size));
      }
      contents.axes = kSystems[system];
    }
  }
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
    const std::uint64_t most = size + (header.has_extensions ? kMostExtensionBytes : 0);
    std::string unpacked;
    if (is_gzip) {
      unpacked = gunzipped(origin, bytes, size, most);
      bytes = unpacked;
    }
    if (bytes.size() < size || bytes.size() > most) {
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
          decode_signed_three(load_number<std::uint32_t>(record(4)), slots + kRotationSlot);
        }
        for (int k = 0; k < rest; ++k) {
          for (int channel = 0; channel < 3; ++channel) {
            const int byte = byte_at(record(5) + 3 * k + channel);
            slots[rest_slot(header.degree, channel, k)] = static_cast<float>((byte - 128) / 128.0);
          }
        }
      });
  if (header.antialiased) contents.notes.emplace_back(kAntialiasedNote);
  read_extensions(origin, streams.extensions, contents);
  return contents;
}

SceneContents read_spz(const std::string& path, const SceneReadOptions& options) {
  const InputFile file(path);
  SceneContents contents = read_spz_bytes(path, file.text_from(0, file.size_bytes()), options);
  if (options.axes.empty() && contents.axes.empty()) {
    contents.notes.emplace_back(
        "it states no axes and is read as it is stored; a file made as SPZ asks needs "
        "--scene-axes rub to fit the cameras of its photographs");
  }
  return contents;
}

}  // namespace sgs
