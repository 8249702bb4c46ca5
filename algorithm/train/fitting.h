// A scene is fitted to photographs a step at a time: training and tunings alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

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

}  // namespace sgs
