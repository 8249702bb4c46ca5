// Sweeps.
#include "testbench/stability/study.h"

#include <algorithm>
#include <cmath>

namespace sgs {

void Deviation::add(const Deviation& other) {
  if (other.error > error || (other.error == error && other.bound > bound)) {
    error = other.error;
    bound = other.bound;
  }
  share = std::max(share, other.share);
}

std::vector<PlaceResult> run(const Study& study, int samples, std::uint64_t seed) {
  std::vector<PlaceResult> results;
  for (const double place : study.places) {
    Random random(seed);
    PlaceResult result{place, {}};
    for (int i = 0; i < (study.drawn ? samples : 1); ++i)
      result.worst.add(study.sample(place, random));
    results.push_back(result);
  }
  return results;
}

double breaks_at(const std::vector<PlaceResult>& results) {
  const auto is_whole = [](const PlaceResult& r) { return r.worst.error <= kBroken; };
  const auto last_whole = std::find_if(results.rbegin(), results.rend(), is_whole);
  return last_whole == results.rbegin() ? std::nan("") : last_whole.base()->place;
}

std::vector<double> decades(int first, int last) {
  std::vector<double> places;
  const int step = first < last ? 1 : -1;
  for (int power = first; power != last + step; power += step) {
    places.push_back(std::pow(10.0, power));
  }
  return places;
}

double log_uniform(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

std::vector<Study> all_studies() {
  std::vector<Study> all;
  for (const auto& some : {camera_studies(), projection_studies(), exponent_studies(),
                           colour_studies(), blend_studies(), gradient_studies()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace sgs
