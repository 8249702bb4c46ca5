// A scene is fitted to photographs a step at a time: training and tunings alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithm/train/comparison.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/additional_losses.h"
#include "algorithm/tune/cloud_gradient.h"
#include "algorithm/tune/group_sequences.h"

namespace sgs {

// A loss or a derivative is not a number any more, or a parameter would leave what a scene may
// hold; what() names step and Gaussian.
class NotFinite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct FittingStep {
  int number;  // from 0
  std::size_t photograph;
  double loss;
};

class Fitting {
 public:
  virtual ~Fitting() = default;

  // The next one. Throws NotFinite; then everything is what it was before the step, or, where a
  // parameter would have left what a scene may hold, all but that Gaussian has moved. Either can be
  // saved.
  virtual FittingStep step() = 0;

  virtual int next_step() const = 0;
  virtual int steps() const = 0;
  bool done() const { return next_step() >= steps(); }
  virtual std::size_t gaussians() const = 0;

  // All that the next step depends on, for a checkpoint.
  virtual std::string saved() const = 0;
};

// The photograph that each step looks at: all of them once each time through, in an order drawn
// anew each time: it follows from the seed and the step.
class ViewOrder {
 public:
  explicit ViewOrder(std::uint64_t seed) : seed_(seed) {}

  // count: of the photographs, the same each time.
  std::size_t at(int step, std::size_t count);

 private:
  std::uint64_t seed_;
  std::vector<std::size_t> order_;
  int order_of_ = -1;  // which time through that is
};

// How a scene that stands is tuned: steps and rates, the order that its pictures are drawn in, and
// what is added to the photometric loss.
struct TuningConfig {
  int steps = 3'000;
  std::uint64_t seed = 1;  // seeds the order of views
  ComparisonRule comparison;
  // Rates are the original's, centres rest; times `rate` at first and `last_rate` of that in the
  // end, falling exponentially.
  LearningSchedule rates;
  double rate = 1, last_rate = 0.1;

  // step: from 0.
  LearningRates rates_at(int step) const;
};

// The order that a tuning's pictures are drawn in, and how.
struct DrawingOrder {
  // The sequences of view number `at`, of a cloud whose Gaussians stand where they stood at the
  // first call.
  std::function<GroupSequences(std::size_t at, const View<float>& view,
                               const ActivatedCloud& cloud)>
      sequences;
  glm::vec3 background{0.0F};
  BlendPrecision precision = BlendPrecision::kSingle;
};

inline DrawingOrder reference_order() {
  return {[](std::size_t, const View<float>& view, const ActivatedCloud& cloud) {
    return reference_sequences(view, cloud);
  }};
}

// plan: must outlive the order.
inline DrawingOrder paper_order(VisitPlan& plan) {
  return {[&plan](std::size_t at, const View<float>& view, const ActivatedCloud& cloud) {
            return plan.sequences(at, view, cloud);
          },
          plan.order().background, plan.order().precision};
}

// A term that a tuning adds to the photometric loss. Adds its derivative to the gradient of the
// picture of these sequences; returns its part of the loss. cloud: activate(parameters).
using Penalty = std::function<double(const View<float>& view, const GroupSequences& sequences,
                                     const GaussianCloud& parameters, const ActivatedCloud& cloud,
                                     CloudGradient& gradient)>;

// beta L_CBP. precision: that the sequences are drawn in.
inline Penalty boundary_loss(double beta, BlendPrecision precision,
                             const BoundaryPenaltyConfig& config) {
  return [=](const View<float>&, const GroupSequences& sequences, const GaussianCloud&,
             const ActivatedCloud& cloud, CloudGradient& gradient) {
    const BoundaryPenalty penalty = boundary_penalty(sequences, cloud, precision, config);
    add_boundary_gradient(penalty, beta, sequences, cloud, gradient);
    return beta * penalty.value;
  };
}

// weight times the mean price of streaming.
inline Penalty streaming_loss(double weight, const PixelSize& group) {
  return
      [=](const View<float>& view, const GroupSequences& sequences, const GaussianCloud& parameters,
          const ActivatedCloud& cloud, CloudGradient& gradient) {
        return weight *
               add_streaming_gradient(view, sequences, parameters, cloud, group, weight, gradient);
      };
}

}  // namespace sgs
