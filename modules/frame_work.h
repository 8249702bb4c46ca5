// What a golden renderer counted of a frame, for estimates of the machines that draw it.
#pragma once

#include <cstddef>
#include <memory>

#include "modules/golden_frame.h"

namespace sgs {

// Each machine knows its own.
class FrameWork {
 public:
  virtual ~FrameWork() = default;
  // That it takes of the host's memory.
  virtual std::size_t size_bytes() const = 0;
};

struct CountedFrame {
  GoldenFrame golden;
  std::shared_ptr<const FrameWork> work;
};

}  // namespace sgs
