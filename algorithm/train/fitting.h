// What is made to come nearer to photographs, a step at a time: training and tunings alike.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace sgs {

// A loss or a parameter is not a number any more; what() names step and Gaussian.
class NotFinite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct FittingStep {
  int number;  // from 0
  std::size_t photograph;
  double loss, l1, ssim;
  std::size_t seen;  // Gaussians that the step moved
};

class Fitting {
 public:
  virtual ~Fitting() = default;

  // The next one. Throws NotFinite; everything is then what it was before the step.
  virtual FittingStep step() = 0;

  virtual int next_step() const = 0;
  virtual int steps() const = 0;
  bool done() const { return next_step() >= steps(); }
  virtual std::size_t gaussians() const = 0;

  // All that the next step depends on, for a checkpoint.
  virtual std::string saved() const = 0;
};

}  // namespace sgs
