// The option's text, and the machine's key.
#include "testbench/streaminggs/run/second_eye.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <system_error>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {
namespace {

// Refuses a machine for other eyes than --stereo draws for.
void check_eyes_given(RunConfig& config, bool two) {
  for (const ConfigOrigin& value : config.origins) {
    if (value.path != "eyes") continue;
    const auto eyes = parse_json(to_json(config), "the configuration").at("eyes");
    if ((eyes > 1) == two) continue;
    throw InputError(
        fmt::format("{}: eyes: got {} {} --stereo, expected {}: --stereo sets it, and says how far "
                    "they are apart",
                    value.origin, eyes.dump(), two ? "with" : "without", two ? 2 : 1));
  }
}

}  // namespace

void add_stereo_to(CommandLine& line, std::string& stereo) {
  line.text("--stereo", stereo,
            "a second eye beside each camera, as ipd=0.064 to its right in world units, with "
            "parallel axes: a frame is two pictures");
  line.refuses_empty("--stereo", "ipd=DISTANCE of the eyes in world units");
}

double eyes_apart(const std::string& stereo) {
  constexpr double kMostApart = 1e6;  // the unit may be a micrometre
  if (stereo.empty()) return 0;
  const std::string key = "ipd=";
  double distance = 0;
  const char* const end = stereo.data() + stereo.size();
  const bool named = stereo.rfind(key, 0) == 0;
  const auto read = std::from_chars(stereo.data() + (named ? key.size() : 0), end, distance);
  if (!named || read.ec != std::errc() || read.ptr != end || !(distance > 0) ||
      distance > kMostApart) {
    throw InputError(fmt::format(
        "--stereo: got '{}', expected ipd=DISTANCE of the eyes in world units, above 0 and at most "
        "{}: their axes are parallel",
        stereo, kMostApart));
  }
  return distance;
}

void draw_eyes(RunConfig& config, double apart) {
  check_eyes_given(config, apart > 0);
  if (apart == 0 || config.design->draw_two_eyes()) return;
  throw InputError(fmt::format(
      "--stereo: got it with machine {}, which draws one eye a frame, expected exact or gscore",
      config.machine()));
}

}  // namespace sgs
