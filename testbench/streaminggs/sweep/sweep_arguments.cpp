// Options of a sweep, and what goes together of them.
#include "testbench/streaminggs/sweep/sweep_arguments.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "testbench/streaminggs/run/second_eye.h"

namespace sgs {
namespace {

constexpr const char* kStandardInput = "-";
constexpr std::uint32_t kMostSideBySide = 1024;

}  // namespace

void SweepArguments::add_to(CommandLine& line) {
  line.list("SCENE", scenes, kSceneForms);
  line.texts("--axis", axes, "KEY=V1,V2,...; a grid of all of them; may be repeated");
  line.file("--points", points,
            "in place of a grid a file with a point a line, KEY=VALUE ... or a JSON object, or - "
            "for standard input: each answered there as soon as it is simulated");
  line.file("--out", out, "results, a JSON object a line; what it holds is not simulated again",
            Given::kAlways);
  line.file("--csv", csv, "write those of this sweep's points as a table, too");
  line.whole("-j,--jobs", side_by_side, 1, kMostSideBySide,
             "simulations side by side; all cores if not given");
  config.add_to(line);
  config.add_fitting_to(line);
  line.texts("--cameras", cameras,
             "cameras as render takes them, for all scenes or one for each in their order; "
             "built-in scenes bring "
             "their own; may be repeated");
  all.add_choice_of_views_to(line);
  add_stereo_to(line, stereo);
  all.add_weighing_to(line);
  all.add_reading_to(line);
  line.file("--technology", technology, "table of energy and area");
}

bool SweepArguments::streaming() const { return points == kStandardInput; }

std::vector<SceneArguments> SweepArguments::each_scene() const {
  const std::size_t files = cameras.size();
  if (files > 1 && files != scenes.size()) {
    throw InputError(
        fmt::format("--cameras: got {} files for {} scenes, expected one for all or one for each "
                    "in their order",
                    files, scenes.size()));
  }
  std::vector<SceneArguments> all_of_them;
  for (const std::string& scene : scenes) {
    SceneArguments& one = all_of_them.emplace_back(all);
    one.scene = scene;
    if (files > 0) one.cameras_path = cameras[files == 1 ? 0 : all_of_them.size() - 1];
  }
  return all_of_them;
}

std::vector<SweepPoint> SweepArguments::listed_points() const {
  if (points.empty() == axes.empty()) {
    throw InputError("--axis, --points: got both or neither, expected a grid or a list of points");
  }
  if (!axes.empty()) return grid_of(axes);
  if (streaming()) return {};
  return read_points(points);
}

void SweepArguments::check_places() const {
  OutputPlan plan;
  for (const SceneArguments& scene : each_scene()) scene.add_inputs_to(plan);
  plan.add_input(config.path());
  plan.add_input(technology);
  if (!streaming()) plan.add_input(points);
  plan.add_output(out);
  if (!csv.empty()) plan.add_output(csv);
  plan.check();
}

}  // namespace sgs
