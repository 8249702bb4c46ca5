// Files, libzip, zlib and libzstd.
#include "algorithm/scene_files/stored_bytes.h"

#include <fmt/format.h>
#include <zip.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

class FolderParts : public SceneParts {
 public:
  explicit FolderParts(const fs::path& folder)
      : SceneParts(folder.empty() ? "." : folder.string()) {}
  std::string bytes(const std::string& name) const override {
    check_name(name);
    const InputFile file((fs::path(path_) / name).string());
    return file.text_from(0, file.size_bytes());
  }
};

struct CloseZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

class ZipParts : public SceneParts {
 public:
  explicit ZipParts(const std::string& path)
      : SceneParts(path), size_bytes_(InputFile(path).size_bytes()) {
    int code = 0;
    zip_.reset(zip_open(path.c_str(), ZIP_RDONLY, &code));
    if (zip_ == nullptr) {
      zip_error_t error;
      zip_error_init_with_code(&error, code);
      const std::string what = zip_error_strerror(&error);
      zip_error_fini(&error);
      throw InputError(
          fmt::format("{}: not a zip that can be read ({}), expected a SOG scene in "
                      "one",
                      path, what));
    }
  }

  std::string bytes(const std::string& name) const override {
    check_name(name);
    zip_stat_t stat;
    zip_stat_init(&stat);
    constexpr zip_uint64_t kNeeded = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
    if (zip_stat(zip_.get(), name.c_str(), 0, &stat) != 0 || (stat.valid & kNeeded) != kNeeded) {
      throw InputError(fmt::format("{}: holds no {}, expected it in a SOG scene", path_, name));
    }
    constexpr std::uint64_t kMostRatio = 1032;  // of deflate
    const bool stored = stat.comp_method == ZIP_CM_STORE;
    if ((!stored && stat.comp_method != ZIP_CM_DEFLATE) || stat.comp_size > size_bytes_ ||
        stat.size / (stored ? 1 : kMostRatio) > stat.comp_size) {
      throw InputError(
          fmt::format("{}: got {} bytes by method {} out of {}, expected a part that "
                      "is stored or deflated",
                      origin(name), stat.size, stat.comp_method, stat.comp_size));
    }
    std::string out(stat.size, '\0');
    const std::unique_ptr<zip_file_t, CloseZip> file(zip_fopen(zip_.get(), name.c_str(), 0));
    char more = 0;  // reading past the end checks the sum
    if (file == nullptr ||
        zip_fread(file.get(), out.data(), out.size()) != static_cast<zip_int64_t>(out.size()) ||
        zip_fread(file.get(), &more, 1) != 0) {
      throw InputError(
          fmt::format("{}: damaged, expected {} bytes with a right sum", origin(name), stat.size));
    }
    return out;
  }

 private:
  std::uint64_t size_bytes_;
  std::unique_ptr<zip_t, CloseZip> zip_;
};

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

void SceneParts::check_name(const std::string& name) const {
  const fs::path place = fs::path(name).lexically_normal();
  if (name.empty() || place.is_absolute() || *place.begin() == "..") {
    throw InputError(
        fmt::format("{}: got the name \"{}\", expected one below this place", path_, name));
  }
}

std::unique_ptr<SceneParts> open_zip(const std::string& path) {
  return std::make_unique<ZipParts>(path);
}

std::unique_ptr<SceneParts> open_folder_of(const std::string& path) {
  return std::make_unique<FolderParts>(fs::path(path).parent_path());
}

std::string gunzipped_start(const std::string& origin, std::string_view gzip,
                            std::uint64_t most_bytes) {
  std::string out(most_bytes, '\0');
  out.resize(Inflater(origin, gzip).fill(out));
  return out;
}

std::string gunzipped(const std::string& origin, std::string_view gzip, std::uint64_t least_bytes,
                      std::uint64_t most_bytes) {
  check_room(origin, gzip.size(), kDeflateRatio, least_bytes);
  std::string out(most_bytes, '\0');
  Inflater inflater(origin, gzip);
  out.resize(inflater.fill(out));
  if (out.size() < least_bytes) {
    throw InputError(
        fmt::format("{}: got {} bytes out of gzip, expected {}", origin, out.size(), least_bytes));
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
