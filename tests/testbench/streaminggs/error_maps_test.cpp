// error_maps.h: which maps a view has, and what they show.
#include "testbench/streaminggs/report/error_maps.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithm/image/error_map.h"

namespace sgs {
namespace {

// One pixel, a step of loss a channel value.
Image grey(float value) {
  Image image(1, 1);
  image.at(0, 0) = glm::vec3(value);
  return image;
}

ViewResult view_that_lost(std::uint64_t missed, std::uint64_t misordered) {
  ViewResult view;
  view.reference = grey(0);
  view.decoded_reference = grey(0.125F);
  view.golden.image = grey(0.875F);
  view.frame = grey(0.9375F);
  view.golden.missed = missed;
  view.golden.misordered = misordered;
  if (is_lossy(view.golden)) {
    view.order_loss.emplace();
    view.order_loss->in_order = grey(0.375F);
    view.order_loss->exactly = view.golden.image;
    view.order_loss->missed.share = 0.25;
    view.order_loss->misordered.share = 0.5;
  }
  return view;
}

std::vector<std::string> names_of(const std::vector<ErrorMap>& maps) {
  std::vector<std::string> names;
  for (const ErrorMap& map : maps) names.push_back(map.file);
  return names;
}

const Image& map_of(const std::vector<ErrorMap>& maps, const std::string& file) {
  for (const ErrorMap& map : maps) {
    if (map.file == file) return map.image;
  }
  throw std::runtime_error("no map " + file);
}

TEST_CASE("error maps: a map for each loss that there is") {
  struct Case {
    std::uint64_t missed, misordered;
    std::vector<std::string> files;
  };
  for (const Case& c : std::vector<Case>{{3, 5, {"error.png", "missed.png", "misordered.png"}},
                                         {0, 0, {"error.png"}},
                                         {0, 1, {"error.png", "misordered.png"}},
                                         {1, 0, {"error.png", "missed.png"}}}) {
    CAPTURE(c.missed, c.misordered);
    CHECK(names_of(error_maps(view_that_lost(c.missed, c.misordered))) == c.files);
  }
  const std::vector<std::string> all(std::begin(kErrorMapFiles), std::end(kErrorMapFiles));
  CHECK(names_of(error_maps(view_that_lost(1, 1))) == all);
}

TEST_CASE("error maps: the whole error, and the step that each loss makes, with its share") {
  ViewResult view = view_that_lost(1, 1);
  const std::vector<ErrorMap> maps = error_maps(view);
  struct Case {
    std::string file;
    double error;
  };
  for (const Case& c :
       std::vector<Case>{{"error.png", 0.9375}, {"missed.png", 0.25}, {"misordered.png", 0.5}}) {
    const glm::vec3 got = map_of(maps, c.file).at(0, 0);
    CAPTURE(c.file);
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(got[k] - error_colour(c.error)[k]) <= 0.5F / 255 + 1e-6F);
    }
  }
  // Another share is another legend; that of the other map is not its own.
  view.order_loss->missed.share = 0.75;
  const std::vector<ErrorMap> others = error_maps(view);
  CHECK(map_of(others, "missed.png").pixels != map_of(maps, "missed.png").pixels);
  CHECK(map_of(others, "misordered.png").pixels == map_of(maps, "misordered.png").pixels);
}

}  // namespace
}  // namespace sgs
