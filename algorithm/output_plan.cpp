// The checks of output_plan.h.
#include "algorithm/output_plan.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "algorithm/input_error.h"
#include "algorithm/output_file.h"

namespace sgs {

void OutputPlan::check() const {
  namespace fs = std::filesystem;
  std::map<fs::path, std::string> places;
  for (const std::string& output : outputs_) {
    { const OutputFile can_be_made(output); }
    const fs::path place = fs::weakly_canonical(fs::absolute(output));
    for (const std::string& input : inputs_) {
      std::error_code ignored;  // one of them is not there
      if (fs::equivalent(place, input, ignored)) {
        throw InputError(
            fmt::format("{}: is the same file as the input {}, expected another", output, input));
      }
    }
    const auto [same, first] = places.emplace(place, output);
    if (!first) {
      throw InputError(fmt::format("{}: is the same file as the output {}, expected another",
                                   output, same->second));
    }
  }
  for (const auto& [place, output] : places) {
    for (fs::path folder = place.parent_path(); folder != folder.root_path();
         folder = folder.parent_path()) {
      const auto file = places.find(folder);
      if (file == places.end()) continue;
      throw InputError(fmt::format(
          "{}: lies below {}, which is an output itself, expected a folder", output, file->second));
    }
  }
}

}  // namespace sgs
