// Quantisation-aware fine-tuning (StreamingGS, DAC 2025): a scene and its codebooks, learned
// together through what the units decode.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/codebook_entries.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/photographs.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

struct QuantisedTuningConfig : TuningConfig {
  int reassign_every = 100;  // steps
  SecondHalfEncoding encoding = SecondHalfEncoding::kVq;
};

// Each step draws what the records decode to. Its derivatives go to the entries, those of all
// Gaussians that use one together, and straight through to each Gaussian's own parameters as if
// nothing had been rounded; every so many steps these find the entries that suit them best anew.
// Largest scale and opacity have no codebook; centres rest.
class QuantisedTuner : public Fitting {
 public:
  // All that there is to save.
  struct State {
    int next_step = 0;
    GaussianCloud own;
    AdamMoments moments;
    CodebookEntries::State entries;
    QuantisedCloud quantised;
    std::uint64_t reassigned = 0;
  };
  // The measures by which indices are found, as quantise() has them.
  struct Weighing {
    std::vector<float> weights, pixel_sizes;
  };

  // photographs: loaded; must outlive the tuner. given: in the order's storage order; quantised: of
  // it.
  QuantisedTuner(const QuantisedTuningConfig& config, const Photographs& photographs,
                 DrawingOrder order, Weighing weighing, const ActivatedCloud& given,
                 QuantisedCloud quantised);
  // state: of a tuner of this given cloud.
  QuantisedTuner(const QuantisedTuningConfig& config, const Photographs& photographs,
                 DrawingOrder order, Weighing weighing, State state);

  FittingStep step() override;
  int next_step() const override { return next_step_; }
  int steps() const override { return config_.steps; }
  std::size_t gaussians() const override { return file_.size(); }
  std::string saved() const override;
  static State restored(const std::string& saved);

  // As it would be packed.
  StoredScene stored(const StorageConfig& storage) const;
  // Share of the Gaussians that got another entry of some codebook the last time.
  double reassigned() const;

 private:
  void align(const std::vector<std::uint32_t>& indices);
  void refresh(const std::vector<std::uint32_t>& indices);
  void to_own_parameters(CloudGradient& gradient) const;
  void reassign();
  GaussianCloud parameters_of(const ActivatedCloud& drawn) const;

  const QuantisedTuningConfig config_;
  const Photographs& photographs_;
  const DrawingOrder order_;
  const Weighing weighing_;
  int next_step_ = 0;
  // The Gaussians as they would be without codebooks. log_scales: that of the largest scale, then
  // those of the ratios of the two others to it.
  GaussianCloud own_;
  GaussianCloud file_;    // the same with log_scales as files have them
  ActivatedCloud exact_;  // activate(file_)
  QuantisedCloud quantised_;
  CodebookEntries entries_;
  Adam adam_;
  ViewOrder view_order_;
  CloudGradient gradient_;
  std::uint64_t reassigned_ = 0;
};

}  // namespace sgs
