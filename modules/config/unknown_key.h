// A key that the configuration does not have.
#pragma once

#include <string>
#include <utility>

#include "algorithm/files/input_error.h"

namespace sgs {

struct UnknownKey : InputError {
  UnknownKey(const std::string& message, std::string key_path)
      : InputError(message), path(std::move(key_path)) {}
  const std::string path;  // from the document's root
};

}  // namespace sgs
