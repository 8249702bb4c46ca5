// Bytes of a scene as they are stored: in several files, in a zip, in streams of gzip and zstd. No
// more room is made than the stored bytes can fill.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace sgs {

// The files that one scene is made of, out of a folder or a zip.
class SceneParts {
 public:
  virtual ~SceneParts() = default;
  // The whole part `name`. Throws InputError where it is missing or damaged.
  virtual std::string bytes(const std::string& name) const = 0;
  // The place of a part, for messages.
  std::string origin(const std::string& name) const { return path_ + "/" + name; }
  // Throws InputError for a name that leads elsewhere.
  void check_name(const std::string& name) const;

 protected:
  explicit SceneParts(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

std::unique_ptr<SceneParts> open_zip(const std::string& path);
// The folder that the file at `path` lies in.
std::unique_ptr<SceneParts> open_folder_of(const std::string& path);

// The first bytes of what a gzip stream holds, at most `most_bytes`. origin: for messages. Throws
// InputError for damaged streams.
std::string gunzipped_start(const std::string& origin, std::string_view gzip,
                            std::uint64_t most_bytes);

// All of it, at least `least_bytes` and at most `most_bytes`. Throws InputError also where it is
// of another size, or where something follows.
std::string gunzipped(const std::string& origin, std::string_view gzip, std::uint64_t least_bytes,
                      std::uint64_t most_bytes);

// All that the zstd frames hold. Throws InputError where they are damaged or hold another size.
std::string unzstd(const std::string& origin, std::string_view zstd, std::uint64_t size_bytes);

}  // namespace sgs
