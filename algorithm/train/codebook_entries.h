// The entries of the codebooks as parameters that are learned: as a file has them, a cloud for each
// codebook of which only the entry's own parameters count.
#pragma once

#include <array>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

class CodebookEntries {
 public:
  // All that there is to save.
  struct State {
    std::array<GaussianCloud, kCodebookCount> entries;  // scale: log_scales.yz, of the ratios
    std::array<AdamMoments, kCodebookCount> moments;
  };

  CodebookEntries(const QuantisedCloud& quantised, int sh_degree);

  // One step of every entry that a Gaussian of the gradient uses, then the codebooks' words.
  // gradient: of the decoded Gaussians, scales in the entries' order; an entry's is the sum over
  // those that use it.
  void step(const CloudGradient& gradient, const LearningRates& rates, QuantisedCloud& quantised);

  // After words were changed from `before`: these entries begin anew.
  void replace(const std::array<std::vector<float>, kCodebookCount>& before,
               const QuantisedCloud& quantised);

  State state() const;
  void restore(State state);

 private:
  std::size_t count(std::size_t codebook) const { return entries_[codebook].size(); }
  void read(std::size_t codebook, std::size_t entry, const float* words);
  void write(std::size_t codebook, std::size_t entry, float* words) const;

  std::array<GaussianCloud, kCodebookCount> entries_;
  std::vector<Adam> adam_;  // [codebook]
};

}  // namespace sgs
