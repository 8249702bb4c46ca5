// A formula as it is computed, in one arithmetic, along one axis of difficulty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "testbench/builtin/random.h"
#include "testbench/stability/bounded.h"
#include "testbench/stability/exact.h"

namespace sgs {

constexpr double u = Single::kRoundoff, h = Half::kRoundoff;  // as laws name them
constexpr double kBroken = 1e-2;  // an error above it, or no number at all: it breaks here

// How far off a computation is and was proven to be at most, in units of its study.
struct Deviation {
  double error = 0;  // the largest of the values; infinite where one is no finite number
  double bound = 0;  // bound on that value; infinite where nothing is proven
  double share = 0;  // largest error / bound: 1 or less if the proofs are right

  void add(const Deviation& other);
};

template <class Format>
Deviation deviation(const Bounded<Format>& computed, const Exact& exact, const Exact& unit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!std::isfinite(computed.value)) return {kInfinity, kInfinity, 0};
  const Exact error = abs(Exact(computed.value) - exact) / unit,
              bound = Exact(computed.error) / unit;
  const auto share = computed.error > 0 ? static_cast<double>(Exact(error / bound))
                                        : (error > 0 ? kInfinity : 0.0);
  return {static_cast<double>(error), static_cast<double>(bound), share};
}

struct Study {
  std::string formula;
  std::string form;        // the way in which units and renderers compute it
  std::string arithmetic;  // float, half
  std::string axis;        // quantity that the places are values of
  std::string unit;        // unit of the errors
  std::vector<double> places;
  std::function<Deviation(double place, Random&)> sample;  // one random case at a place
  // The error by analysis: a function of the place, and in words. u: unit roundoff.
  std::function<double(double place)> law;
  std::string law_text;
  std::string why;    // a sentence or two: the part that breaks, the reason, and the remedy
  bool drawn = true;  // else all cases of a place are one
};

// A law that is the same at all places; or up to a place, and says nothing beyond.
inline auto flat(double error) {
  return [=](double) { return error; };
}
inline auto flat_to(double last, double error) {
  return [=](double place) { return place <= last ? error : INFINITY; };
}

struct PlaceResult {
  double place;
  Deviation worst;
};

// Runs `samples` cases at each place; the same for each seed.
std::vector<PlaceResult> run(const Study& study, int samples, std::uint64_t seed);

// The first place in the order of the study from which on it is broken; none: NaN.
double breaks_at(const std::vector<PlaceResult>& results);

// 10^first to 10^last, a place each decade.
std::vector<double> decades(int first, int last);

double log_uniform(Random& random, double low, double high);

std::vector<Study> camera_studies();
std::vector<Study> projection_studies();
std::vector<Study> exponent_studies();
std::vector<Study> colour_studies();
std::vector<Study> blend_studies();
std::vector<Study> gradient_studies();
std::vector<Study> all_studies();

}  // namespace sgs
