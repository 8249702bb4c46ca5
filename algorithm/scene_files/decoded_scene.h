// What readers of scene files share: Gaussians decoded one by one on all threads, and numbers in
// few bits.
#pragma once

#include <Imath/half.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_vertex.h"

namespace sgs {

// A cloud of `count` Gaussians of `degree`. decode(index, slots) fills the slots of ply_vertex.h
// with what an INRIA .ply would hold; it runs on several threads. Faulty ones are refused or left
// out as `options` say.
template <class Decode>
SceneContents decoded_scene(const std::string& path, std::uint64_t count, int degree,
                            const SceneReadOptions& options, const Decode& decode) {
  SceneContents contents;
  contents.cloud.resize(count, degree);
  std::vector<VertexFault> faults;
  std::mutex faults_mutex;
  tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, count, 4096), [&](const auto& range) {
    std::array<float, kMaxSlots> slots{};
    std::vector<VertexFault> own;
    for (std::uint64_t i = range.begin(); i != range.end(); ++i) {
      decode(i, slots.data());
      store_vertex(slots.data(), i, contents.cloud, own);
    }
    const std::lock_guard<std::mutex> lock(faults_mutex);
    faults.insert(faults.end(), own.begin(), own.end());
  });
  std::sort(faults.begin(), faults.end(),
            [](const VertexFault& a, const VertexFault& b) { return a.vertex < b.vertex; });
  settle_faults(path, faults, options, contents);
  return contents;
}

// f_rest coefficients of a channel, and the slot of one of them.
constexpr int rest_coeff_count(int degree) { return sh_coeff_count(degree) - 1; }
constexpr int rest_slot(int degree, int channel, int coeff) {
  return kRestSlot + channel * rest_coeff_count(degree) + coeff;
}

// A little-endian number at `bytes`.
template <class T>
T load_number(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}
inline std::uint8_t byte_at(const char* bytes) { return load_number<std::uint8_t>(bytes); }
inline float half_at(const char* bytes) {
  Imath::half value;
  value.setBits(load_number<std::uint16_t>(bytes));
  return value;
}

// f_dc of a colour in [0, 1]: what the SH basis of degree 0 makes the colour of.
inline double dc_of_colour(double colour) { return (colour - 0.5) / 0.28209479177387814; }

// The logit of an opacity of 8 bits, kept off its infinite ends as the decoders of these formats
// do.
inline float logit_of_byte(std::uint8_t opacity) {
  constexpr double kEnd = 1e-6;
  const double kept = std::clamp(opacity / 255.0, kEnd, 1 - kEnd);
  return static_cast<float>(std::log(kept / (1 - kept)));
}

// A quaternion of which all components but `largest` are stored: next() gives them in `order`, as
// numbers of w x y z, and the largest makes the length 1.
template <class Next>
void decode_smallest_three(const std::array<int, 4>& order, int largest, const Next& next,
                           float* rotation) {
  double squared = 0;
  for (const int k : order) {
    if (k == largest) continue;
    const double part = next();
    rotation[k] = static_cast<float>(part);
    squared += part * part;
  }
  rotation[largest] = static_cast<float>(std::sqrt(std::max(0.0, 1 - squared)));
}

}  // namespace sgs
