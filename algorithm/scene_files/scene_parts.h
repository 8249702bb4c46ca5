// The files that one scene is made of, out of a folder or a zip.
#pragma once

#include <memory>
#include <string>

namespace sgs {

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

}  // namespace sgs
