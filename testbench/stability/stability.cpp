// stability: how far each formula of one Gaussian is from what it is without rounding, as JSON on
// standard output; scripts/results.py stability_table makes the table of it.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <systemc>

#include "testbench/command_line/program.h"
#include "testbench/command_line/version.h"
#include "testbench/stability/study.h"
#include "tlm/no_banner.h"

namespace {

using namespace sgs;
using Json = nlohmann::ordered_json;

// JSON has no infinity: null.
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json measured(const Study& study, int samples, std::uint64_t seed) {
  const std::vector<PlaceResult> results = run(study, samples, seed);
  Json places = Json::array();
  for (const PlaceResult& r : results) {
    places.push_back({{"place", r.place},
                      {"error", number(r.worst.error)},
                      {"bound", number(r.worst.bound)},
                      {"error_over_bound", number(r.worst.share)},
                      {"law", number(study.law(r.place))}});
  }
  return {{"formula", study.formula},
          {"form", study.form},
          {"arithmetic", study.arithmetic},
          {"axis", study.axis},
          {"unit", study.unit},
          {"law", study.law_text},
          {"breaks_at", number(breaks_at(results))},
          {"why", study.why},
          {"places", places}};
}

}  // namespace

int sc_main(int argc, char* argv[]) {
  std::uint32_t samples = 300;
  std::uint64_t seed = 1;
  CommandLine line("stability",
                   "How far off float and half are from 100 decimal digits, formula by formula");
  line.whole("--samples", samples, 1, 1'000'000, "random cases at each place of a sweep");
  line.whole("--seed", seed, 0, kMostSeed, "of the random cases");
  return run_program(line, argc, argv, [&] {
    Json studies = Json::array();
    for (const Study& study : all_studies()) {
      studies.push_back(measured(study, static_cast<int>(samples), seed));
    }
    const Json out = {{"commit", commit()}, {"samples", samples}, {"studies", studies}};
    fmt::print("{}\n", out.dump(1));
    return kDone;
  });
}
