// Pictures of a stream as its display showed them, in a file without a name: the child that
// simulates writes them, its parent reads them. Those of a long path are larger than a host's
// memory should be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include "modules/frame_job.h"

namespace sgs {

class ShownPictures {
 public:
  // job: of the stream, outlives it. Throws std::runtime_error where no file can be made.
  explicit ShownPictures(const FrameJob& job);

  // Throw std::runtime_error.
  void write(std::uint32_t frame, std::uint32_t eye, const std::byte* bytes);
  std::vector<std::byte> read(std::uint32_t frame, std::uint32_t eye) const;

 private:
  std::uint64_t place(std::uint32_t frame, std::uint32_t eye) const;

  const FrameJob& job_;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace sgs
