// Fields of .splat, compressed PLY, .spz and .ksplat.
#include "tests/algorithm/scene_files/made_scene_files.h"

#include <Imath/half.h>
#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

namespace sgs::test {
namespace {

constexpr float kScales[] = {0.5F, 0.25F, 2.0F};

std::uint16_t half_bits(float value) { return Imath::half(value).bits(); }

}  // namespace

std::string splat_bytes(std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    for (const float value : {x, -x, 0.5F}) put(bytes, value);
    for (const float value : kScales) put(bytes, value);
    for (std::size_t field = 0; field < 8; ++field) put_byte(bytes, code(i, field));
  }
  return bytes;
}

std::string compressed_ply_bytes(std::size_t count, int degree, bool bounded) {
  const std::size_t chunks = (count + 255) / 256;
  std::string bytes =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement chunk {}\n", chunks);
  const auto bounds = [&bytes](std::initializer_list<const char*> names) {
    for (const char* end : {"min", "max"}) {
      for (const char* name : names) bytes += fmt::format("property float {}_{}\n", end, name);
    }
  };
  bounds({"x", "y", "z"});
  bounds({"scale_x", "scale_y", "scale_z"});
  if (bounded) bounds({"r", "g", "b"});
  bytes += fmt::format("element vertex {}\n", count);
  for (const char* name : {"position", "rotation", "scale", "color"}) {
    bytes += fmt::format("property uint packed_{}\n", name);
  }
  if (degree > 0) {
    bytes += fmt::format("element sh {}\n", count);
    for (int k = 0; k < rest_count(degree); ++k) {
      bytes += fmt::format("property uchar f_rest_{}\n", k);
    }
  }
  bytes += "end_header\n";
  for (std::size_t c = 0; c < chunks; ++c) {
    const auto more = static_cast<float>(c);
    for (const float value : {-1 - more, 0.0F, 0.0F, 3 + more, 1.0F, 1.0F}) put(bytes, value);
    for (const float value : {-8.0F, -8.0F, -8.0F, -1.0F, -1.0F, -1.0F}) put(bytes, value);
    if (!bounded) continue;
    for (const float value : {0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F}) put(bytes, value);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t axes = 8 * code(i, 0) << 21 | 4 * code(i, 1) << 11 | 8 * code(i, 2);
    put(bytes, axes);
    put(bytes, static_cast<std::uint32_t>(i % 4) << 30 | 4 * code(i, 3) << 20 |
                   4 * code(i, 4) << 10 | 4 * code(i, 5));
    put(bytes, axes);
    put(bytes, code(i, 6) << 24 | code(i, 7) << 16 | code(i, 8) << 8 | code(i, 9));
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < rest_count(degree); ++k) put_byte(bytes, code(i, 10 + k));
  }
  return bytes;
}

namespace {

// The streams of .spz, one behind the other.
std::vector<std::string> spz_streams(std::uint32_t version, std::size_t count, int degree) {
  std::vector<std::string> streams(degree > 0 ? 6 : 5);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (version == 1) {
        put(streams[0], half_bits(static_cast<float>(code(i, axis))));
      } else {
        const std::int32_t value = static_cast<std::int32_t>(256 * code(i, axis)) - 20000;
        for (const int shift : {0, 8, 16}) put_byte(streams[0], value >> shift & 0xff);
      }
      put_byte(streams[2], code(i, 4 + axis));
      put_byte(streams[3], code(i, 7 + axis));
    }
    put_byte(streams[1], code(i, 3));
    if (version < 3) {
      for (std::size_t k = 0; k < 3; ++k) put_byte(streams[4], code(i, 10 + k));
    } else {
      std::uint32_t word = static_cast<std::uint32_t>(i % 4);
      for (std::size_t k = 0; k < 3; ++k) word = word << 10 | code(i, 10 + k) << 1;
      put(streams[4], word);
    }
    for (int k = 0; k < rest_count(degree); ++k) put_byte(streams[5], code(i, 13 + k));
  }
  return streams;
}

std::string spz_header(std::uint32_t version, std::size_t count, int degree, std::uint32_t last) {
  std::string bytes = "NGSP";
  put(bytes, version);
  put(bytes, static_cast<std::uint32_t>(count));
  put_byte(bytes, degree);
  put_byte(bytes, 12);
  put_byte(bytes, 0);
  put_byte(bytes, last);
  return bytes;
}

}  // namespace

std::string bare_spz_bytes(std::uint32_t version, std::size_t count, int degree) {
  std::string bytes = spz_header(version, count, degree, 0);
  for (const std::string& stream : spz_streams(version, count, degree)) bytes += stream;
  return bytes;
}

std::string gzip_bytes(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string spz_bytes(std::uint32_t version, std::size_t count, int degree) {
  if (version < 4) return gzip_bytes(bare_spz_bytes(version, count, degree));
  const std::vector<std::string> streams = spz_streams(version, count, degree);
  std::string bytes =
      spz_header(version, count, degree, static_cast<std::uint32_t>(streams.size()));
  put(bytes, std::uint32_t{32});
  bytes.resize(32);
  std::string packed;
  for (const std::string& stream : streams) {
    std::string frame(ZSTD_compressBound(stream.size()), '\0');
    frame.resize(ZSTD_compress(frame.data(), frame.size(), stream.data(), stream.size(), 3));
    put(bytes, std::uint64_t{frame.size()});
    put(bytes, std::uint64_t{stream.size()});
    packed += frame;
  }
  return bytes + packed;
}

std::string ksplat_bytes(int compression, std::size_t count, int degree) {
  const std::size_t full = count / 4, buckets = (count + 3) / 4;
  std::string bytes(4096 + 1024, '\0');
  bytes[1] = 1;
  put_at(bytes, 4, std::uint32_t{1});
  put_at(bytes, 16, static_cast<std::uint32_t>(count));
  put_at(bytes, 20, static_cast<std::uint16_t>(compression));
  const auto field = [&bytes](std::size_t at, std::size_t value) {
    put_at(bytes, 4096 + at, static_cast<std::uint32_t>(value));
  };
  field(0, count);
  field(4, count);
  field(8, 4);
  field(12, buckets);
  put_at(bytes, 4096 + 16, 5.0F);
  field(20, 12);
  field(32, full);
  field(36, buckets - full);
  field(40, static_cast<std::size_t>(degree));
  if (full < buckets) put(bytes, static_cast<std::uint32_t>(count - 4 * full));
  for (std::size_t b = 0; b < buckets; ++b) {
    const auto x = static_cast<float>(b);
    for (const float value : {10 * x, 0.0F, -x}) put(bytes, value);
  }
  const auto number = [&](float value) {
    if (compression == 0) {
      put(bytes, value);
    } else {
      put(bytes, half_bits(value));
    }
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (compression == 0) {
        put(bytes, static_cast<float>((axis + 1) * i));
      } else {
        put(bytes, static_cast<std::uint16_t>(256 * code(i, axis)));
      }
    }
    for (const float scale : kScales) number(scale);
    for (const float part : {0.5F, -0.5F, 0.5F, 0.5F}) number(part);
    for (std::size_t k = 3; k < 7; ++k) put_byte(bytes, code(i, k));
    for (int n = 0; n < rest_count(degree); ++n) {
      if (compression == 2) {
        put_byte(bytes, code(i, 7 + n));
      } else {
        number(static_cast<float>(n) / 64 - 1);
      }
    }
  }
  return bytes;
}

}  // namespace sgs::test
