// Whole scenes in each encoding: what `decoded` holds is what the bytes decode to, to the bit.
#include "algorithm/storage/encoded_cloud.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/make_splat.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs {
namespace {

using Encoding = SecondHalfEncoding;

ActivatedCloud cloud_of(unsigned seed, std::size_t count, int degree) {
  return activate(test::random_cloud(seed, count, degree, {0, 0, 0}, 3, 0.01F, 1));
}

VqConfig small_config() {
  VqConfig config;
  config.scale_entries = config.rotation_entries = config.dc_entries = config.sh_entries = 32;
  config.iterations = 3;
  return config;
}

EncodedCloud encode(const ActivatedCloud& cloud, Encoding encoding) {
  if (encoding == Encoding::kRaw) return encode_raw(cloud);
  if (encoding == Encoding::kHalf) return encode_half(cloud);
  const std::vector<float> weights(cloud.size(), 1.0F);
  return encode_quantised(
      cloud, quantise(cloud, weights, std::vector<float>(cloud.size(), 0.0F), small_config()),
      encoding);
}

constexpr Encoding kAll[] = {Encoding::kRaw, Encoding::kHalf, Encoding::kVq, Encoding::kVqPacked};

// Every record, as written, decodes to `decoded`; means and largest scales are the original's.
void check_scene(const ActivatedCloud& cloud, Encoding encoding) {
  INFO("encoding " << static_cast<int>(encoding) << ", " << cloud.size() << " Gaussians of degree "
                   << cloud.sh_degree);
  const EncodedCloud encoded = encode(cloud, encoding);
  CHECK(encoded.format.encoding == encoding);
  CHECK(encoded.format.sh_degree == cloud.sh_degree);
  CHECK(encoded.codebooks.size() == encoded.format.codebook_bytes());
  REQUIRE(encoded.decoded.size() == cloud.size());
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  REQUIRE(encoded.decoded.sh_coeffs.size() == cloud.size() * coeffs);
  std::vector<std::byte> record(encoded.format.bytes() + 1, std::byte{0x5a});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::byte first[kFirstHalfBytes], decoded_first[kFirstHalfBytes];
    encode_first_half(cloud.gaussians[i], first);
    encode_first_half(encoded.decoded.gaussians[i], decoded_first);
    REQUIRE(std::memcmp(first, decoded_first, kFirstHalfBytes) == 0);
    encoded.write_second_half(i, record.data());
    REQUIRE(record.back() == std::byte{0x5a});
    const DecodedGaussian back = decode_second_half(encoded.format, decode_first_half(first),
                                                    record.data(), encoded.codebooks.data());
    REQUIRE(std::memcmp(&back.gaussian, &encoded.decoded.gaussians[i], sizeof back.gaussian) == 0);
    REQUIRE(std::memcmp(back.sh, encoded.decoded.sh(i), coeffs * sizeof(glm::vec3)) == 0);
  }
}

TEST_CASE("encoded cloud: decoded is what the written bytes decode to") {
  for (const Encoding encoding : kAll) {
    for (int degree = 0; degree <= 3; ++degree) check_scene(cloud_of(1, 500, degree), encoding);
  }
}

TEST_CASE("encoded cloud: scales of infinity, which are never drawn, are not drawn decoded") {
  ActivatedCloud cloud = cloud_of(5, 200, 1);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const glm::vec3 scales[] = {{kInfinity, 1, 2}, {1, kInfinity, kInfinity}, {1, 0, kInfinity}};
  for (std::size_t i = 0; i < 3; ++i) cloud.gaussians[i].scale = scales[i];
  const View<float> view = make_view<float>(test::forward_camera(64, 64, 50));
  for (const Encoding encoding : kAll) {
    const EncodedCloud encoded = encode(cloud, encoding);
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      Gaussian<float> g = encoded.decoded.gaussians[i];
      g.mean = {0, 0, 5};
      Splat splat{};
      const bool visible = make_geometry(view, g, splat);
      if (i < 3) CHECK_FALSE(visible);
      drawn += visible ? 1 : 0;
    }
    CHECK(drawn > 150);
  }
}

}  // namespace
}  // namespace sgs
