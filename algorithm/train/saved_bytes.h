// Values as bytes and back, by cereal, little-endian: what states are saved as. For .cpp files: it
// takes long to compile.
#pragma once

#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>
#include <string>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/tune/adam.h"

namespace glm {

template <class Archive>
void serialize(Archive& archive, vec3& v) {
  archive(v.x, v.y, v.z);
}

}  // namespace glm

namespace sgs {

template <class Archive>
void serialize(Archive& archive, GaussianCloud& cloud) {
  archive(cloud.sh_degree, cloud.means, cloud.log_scales, cloud.quats, cloud.opacity_logits,
          cloud.sh_coeffs);
}

template <class Archive>
void serialize(Archive& archive, AdamMoments& moments) {
  std::uint64_t row = moments.row;
  archive(row, moments.values, moments.updates);
  moments.row = row;
}

template <class Value>
std::string saved_bytes(const Value& value) {
  std::ostringstream stream;
  {
    cereal::PortableBinaryOutputArchive archive(
        stream, cereal::PortableBinaryOutputArchive::Options::LittleEndian());
    archive(value);
  }
  return stream.str();
}

// bytes: saved_bytes() of the same type, checked by whoever read them (checkpoint.h).
template <class Value>
void restore_bytes(const std::string& bytes, Value& value) {
  std::istringstream stream(bytes);
  cereal::PortableBinaryInputArchive archive(stream);
  archive(value);
}

}  // namespace sgs
