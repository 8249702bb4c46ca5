// zlib and libzstd.
#include "algorithm/scene_files/compressed_bytes.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

// How many bytes one of deflate, one of zstd (a block of 128 KiB in 4 B) can stand for.
constexpr std::uint64_t kDeflateRatio = 1032, kZstdRatio = 32768;

void check_room(const std::string& origin, std::uint64_t compressed, std::uint64_t ratio,
                std::uint64_t size_bytes) {
  if (size_bytes / ratio > compressed) {
    throw InputError(fmt::format("{}: got {} compressed bytes, expected more for {} bytes", origin,
                                 compressed, size_bytes));
  }
}

class Inflater {
 public:
  Inflater(const std::string& origin, std::string_view gzip) : origin_(origin), left_(gzip) {
    constexpr int kGzipWindow = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipWindow) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  // Fills `out` as far as the stream goes, and returns how far that is.
  std::size_t fill(std::string& out) {
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    std::size_t done = 0;
    while (done < out.size() && !ended_) {
      const std::size_t room = std::min(out.size() - done, kMost);
      if (stream_.avail_in == 0) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(left_.data()));
        stream_.avail_in = static_cast<uInt>(std::min(left_.size(), kMost));
        left_.remove_prefix(stream_.avail_in);
      }
      stream_.next_out = reinterpret_cast<Bytef*>(&out[done]);
      stream_.avail_out = static_cast<uInt>(room);
      const int state = inflate(&stream_, Z_NO_FLUSH);
      done += room - stream_.avail_out;
      ended_ = state == Z_STREAM_END;
      if (state != Z_OK && !ended_) fail();
    }
    return done;
  }

  // The stream's checksum is right and nothing follows.
  void check_end() {
    std::string more(1, '\0');
    if (fill(more) != 0 || !ended_) fail();
    if (stream_.avail_in + left_.size() > 0) {
      throw InputError(fmt::format("{}: got {} bytes behind the gzip stream, expected its end",
                                   origin_, stream_.avail_in + left_.size()));
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw InputError(fmt::format(
        "{}: the gzip stream is damaged or cut off after {} bytes ({}), "
        "expected a whole one of the size that its header states",
        origin_, stream_.total_in, stream_.msg != nullptr ? stream_.msg : "no more input"));
  }

  const std::string& origin_;
  std::string_view left_;
  z_stream stream_{};
  bool ended_ = false;
};

}  // namespace

std::string gunzipped_start(const std::string& origin, std::string_view gzip,
                            std::uint64_t most_bytes) {
  std::string out(most_bytes, '\0');
  out.resize(Inflater(origin, gzip).fill(out));
  return out;
}

std::string gunzipped(const std::string& origin, std::string_view gzip, std::uint64_t size_bytes) {
  check_room(origin, gzip.size(), kDeflateRatio, size_bytes);
  std::string out(size_bytes, '\0');
  Inflater inflater(origin, gzip);
  if (const std::size_t got = inflater.fill(out); got != size_bytes) {
    throw InputError(
        fmt::format("{}: got {} bytes out of gzip, expected {}", origin, got, size_bytes));
  }
  inflater.check_end();
  return out;
}

std::string unzstd(const std::string& origin, std::string_view zstd, std::uint64_t size_bytes) {
  check_room(origin, zstd.size(), kZstdRatio, size_bytes);
  std::string out(size_bytes, '\0');
  const std::size_t got = ZSTD_decompress(out.data(), out.size(), zstd.data(), zstd.size());
  if (ZSTD_isError(got) != 0U) {
    throw InputError(fmt::format("{}: the zstd stream is damaged ({}), expected {} bytes", origin,
                                 ZSTD_getErrorName(got), size_bytes));
  }
  if (got != size_bytes) {
    throw InputError(
        fmt::format("{}: got {} bytes out of zstd, expected {}", origin, got, size_bytes));
  }
  return out;
}

}  // namespace sgs
