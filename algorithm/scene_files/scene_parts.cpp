// Files and libzip.
#include "algorithm/scene_files/scene_parts.h"

#include <fmt/format.h>
#include <zip.h>

#include <filesystem>

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

}  // namespace sgs
