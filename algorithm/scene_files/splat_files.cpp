// The two forms of web viewers in scene_forms.h.
#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/scene_forms.h"

namespace sgs {
namespace {

// .ksplat

constexpr std::uint64_t kMainHeaderBytes = 4096, kSectionHeaderBytes = 1024;
constexpr int kMostCompression = 2;

// Bytes of a record's parts by compression; colour and opacity take 4 B.
struct RecordLayout {
  std::uint64_t number_bytes;  // of scale and rotation
  std::uint64_t centre_bytes, coefficient_bytes;

  std::uint64_t scale_at() const { return centre_bytes; }
  std::uint64_t rotation_at() const { return scale_at() + 3 * number_bytes; }
  std::uint64_t colour_at() const { return rotation_at() + 4 * number_bytes; }
  std::uint64_t rest_at() const { return colour_at() + 4; }
  std::uint64_t bytes(int degree) const {
    return rest_at() + 3 * static_cast<std::uint64_t>(rest_coeff_count(degree)) * coefficient_bytes;
  }
};
constexpr RecordLayout kLayouts[] = {{4, 12, 4}, {2, 6, 2}, {2, 6, 1}};
constexpr std::uint32_t kQuantisedRange = 32767;  // where the file states none

struct Section {
  std::uint64_t count = 0, room = 0;  // Gaussians, and records that there is room for
  std::uint64_t bucket_capacity = 0, full_buckets = 0;
  std::vector<std::uint64_t> bucket_ends;  // of those that are not full: index behind their last
  int degree = 0;
  double unit = 0;           // world units of a step of a coordinate
  std::uint32_t middle = 0;  // the step of a bucket's centre
  std::uint64_t centres_at = 0, bucket_count = 0, records_at = 0;  // places in bytes

  std::uint64_t bucket_of(std::uint64_t index) const {
    if (index < full_buckets * bucket_capacity) return index / bucket_capacity;
    const auto end = std::upper_bound(bucket_ends.begin(), bucket_ends.end(), index);
    return full_buckets + static_cast<std::uint64_t>(end - bucket_ends.begin());
  }
};

// Coefficient and channel of a record's SH numbers: band by band, in each channel by channel.
struct RestPlace {
  int channel, coeff;
};
RestPlace rest_place(int number) {
  constexpr int kBandCoeffs[] = {3, 5, 7};
  int coeffs_before = 0;
  for (const int coeffs : kBandCoeffs) {
    if (number < 3 * coeffs) return {number / coeffs, coeffs_before + number % coeffs};
    number -= 3 * coeffs;
    coeffs_before += coeffs;
  }
  return {0, 0};
}

class KsplatReader {
 public:
  explicit KsplatReader(const std::string& path) : path_(path) {
    const InputFile file(path);
    bytes_ = file.text_from(0, file.size_bytes());
    read_header();
    read_sections();
  }

  SceneContents decoded(const SceneReadOptions& options) const {
    return decoded_scene(path_, count_, degree_, options,
                         [this](std::uint64_t index, float* slots) {
                           std::size_t s = 0;
                           while (index >= sections_[s].count) index -= sections_[s++].count;
                           decode(sections_[s], index, slots);
                         });
  }

 private:
  [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
    throw InputError(fmt::format("{}: got {}, expected {}", path_, got, expected));
  }
  template <class T>
  T number(std::uint64_t at) const {
    return load_number<T>(&bytes_[at]);
  }

  void read_header() {
    if (bytes_.size() < kMainHeaderBytes) {
      refuse(fmt::format("{} bytes", bytes_.size()), "the 4096 bytes of a header of .ksplat");
    }
    if (byte_at(&bytes_[0]) != 0 || byte_at(&bytes_[1]) < 1) {
      refuse(fmt::format("version {}.{} of .ksplat", byte_at(&bytes_[0]), byte_at(&bytes_[1])),
             "0.1 or later");
    }
    section_count_ = number<std::uint32_t>(4);
    count_ = number<std::uint32_t>(16);
    compression_ = number<std::uint16_t>(20);
    if (compression_ > kMostCompression) {
      refuse(fmt::format("compression {} of .ksplat", compression_), "0, 1 or 2");
    }
    const auto least = number<float>(36), most = number<float>(40);
    if (least != 0) rest_least_ = least;
    if (most != 0) rest_most_ = most;
    if (section_count_ > (bytes_.size() - kMainHeaderBytes) / kSectionHeaderBytes) {
      refuse(fmt::format("{} bytes", bytes_.size()),
             fmt::format("the headers of {} sections", section_count_));
    }
  }

  // Bytes that a section takes from `at` on; refuses what the file does not hold.
  std::uint64_t room_for(std::uint64_t at, std::uint64_t count, std::uint64_t size,
                         const char* what) const {
    if (at > bytes_.size() || (size != 0 && count > (bytes_.size() - at) / size)) {
      refuse(fmt::format("{} bytes", bytes_.size()),
             fmt::format("{} {} of {} bytes from byte {} on", count, what, size, at));
    }
    return count * size;
  }

  void read_sections() {
    std::uint64_t at = kMainHeaderBytes + section_count_ * kSectionHeaderBytes, all = 0;
    for (std::uint64_t s = 0; s < section_count_; ++s) {
      const std::uint64_t header = kMainHeaderBytes + s * kSectionHeaderBytes;
      Section section;
      section.count = number<std::uint32_t>(header);
      section.room = number<std::uint32_t>(header + 4);
      section.bucket_capacity = number<std::uint32_t>(header + 8);
      section.bucket_count = number<std::uint32_t>(header + 12);
      const auto block_size = number<float>(header + 16);
      const std::uint64_t bucket_bytes = number<std::uint16_t>(header + 20);
      section.middle = number<std::uint32_t>(header + 24);
      if (section.middle == 0) section.middle = kQuantisedRange;
      section.full_buckets = number<std::uint32_t>(header + 32);
      const std::uint64_t partial_buckets = number<std::uint32_t>(header + 36);
      const int degree = number<std::uint16_t>(header + 40);
      if (degree > 3) refuse(fmt::format("SH degree {}", degree), "0 to 3");
      section.degree = degree;
      if (section.count > section.room) {
        refuse(fmt::format("section {} of {} Gaussians", s, section.count),
               fmt::format("at most {}, its records", section.room));
      }
      section.unit = block_size / 2.0 / section.middle;
      std::uint64_t end = section.full_buckets * section.bucket_capacity;
      const std::uint64_t sizes = room_for(at, partial_buckets, 4, "sizes of buckets");
      for (std::uint64_t b = 0; b < partial_buckets; ++b) {
        end += number<std::uint32_t>(at + 4 * b);
        section.bucket_ends.push_back(end);
      }
      section.centres_at = at + sizes;
      at = section.centres_at +
           room_for(section.centres_at, section.bucket_count, bucket_bytes, "buckets");
      check_buckets(section, s, bucket_bytes, end);
      section.records_at = at;
      at += room_for(at, section.room, kLayouts[compression_].bytes(degree), "records");
      if (section.count > 0) degree_ = std::max(degree_, degree);
      all += section.count;
      sections_.push_back(std::move(section));
    }
    if (all != count_) {
      refuse(fmt::format("{} Gaussians in sections", all), fmt::format("{} as the header", count_));
    }
    if (at != bytes_.size()) {
      refuse(fmt::format("{} bytes behind the last section", bytes_.size() - at),
             "the end of the file");
    }
  }

  // That every Gaussian has a bucket whose centre is there.
  void check_buckets(const Section& section, std::uint64_t s, std::uint64_t bucket_bytes,
                     std::uint64_t end) const {
    if (compression_ == 0 || section.count == 0) return;
    const std::uint64_t buckets = section.full_buckets + section.bucket_ends.size();
    if (end < section.count || buckets > section.bucket_count || bucket_bytes != 12) {
      refuse(fmt::format("section {} of {} Gaussians in {} buckets of {} bytes", s, section.count,
                         section.bucket_count, bucket_bytes),
             fmt::format("{} Gaussians in {} buckets of 12 bytes", end, buckets));
    }
  }

  float stored(const char* at) const {
    return compression_ == 0 ? load_number<float>(at) : half_at(at);
  }

  double coefficient(const char* rest, int number) const {
    if (compression_ < 2) {
      return stored(rest + number * static_cast<int>(kLayouts[compression_].coefficient_bytes));
    }
    return rest_least_ + byte_at(rest + number) / 255.0 * (rest_most_ - rest_least_);
  }

  void decode(const Section& section, std::uint64_t index, float* slots) const {
    const RecordLayout& layout = kLayouts[compression_];
    const char* record = &bytes_[section.records_at + index * layout.bytes(section.degree)];
    for (int i = 0; i < 3; ++i) {
      if (compression_ == 0) {
        slots[kMeanSlot + i] = load_number<float>(record + 4 * i);
      } else {
        const double step = load_number<std::uint16_t>(record + 2 * i);
        const auto centre =
            number<float>(section.centres_at + 12 * section.bucket_of(index) + 4 * i);
        slots[kMeanSlot + i] = static_cast<float>((step - section.middle) * section.unit + centre);
      }
      const double scale = stored(record + layout.scale_at() + i * layout.number_bytes);
      // What the format's own writer makes of a scale of 0.
      slots[kScaleSlot + i] = scale > 0 ? static_cast<float>(std::log(scale)) : -10.0F;
      const double colour = byte_at(record + layout.colour_at() + i) / 255.0;
      slots[kDcSlot + i] = static_cast<float>(dc_of_colour(colour));
    }
    slots[kOpacitySlot] = logit_of_byte(byte_at(record + layout.colour_at() + 3));
    for (int k = 0; k < 4; ++k) {
      slots[kRotationSlot + k] = stored(record + layout.rotation_at() + k * layout.number_bytes);
    }
    std::fill_n(slots + kRestSlot, 3 * rest_coeff_count(degree_), 0.0F);
    for (int n = 0; n < 3 * rest_coeff_count(section.degree); ++n) {
      const RestPlace place = rest_place(n);
      slots[rest_slot(degree_, place.channel, place.coeff)] =
          static_cast<float>(coefficient(record + layout.rest_at(), n));
    }
  }

  const std::string& path_;
  std::string bytes_;
  std::uint64_t section_count_ = 0, count_ = 0;
  int compression_ = 0, degree_ = 0;
  double rest_least_ = -1.5, rest_most_ = 1.5;
  std::vector<Section> sections_;
};

// .splat

constexpr std::uint64_t kSplatBytes = 32;
constexpr int kScaleAt = 12, kColourAt = 24, kOpacityAt = 27, kRotationAt = 28;

void decode_splat_rotation(const char* bytes, float* rotation) {
  std::array<double, 4> q{};
  for (int k = 0; k < 4; ++k) q[k] = (byte_at(bytes + k) / 255.0) * 2 - 1;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; ++k) rotation[k] = static_cast<float>(q[k] / length);
}

}  // namespace

SceneContents read_ksplat(const std::string& path, const SceneReadOptions& options) {
  return KsplatReader(path).decoded(options);
}

SceneContents read_splat(const std::string& path, const SceneReadOptions& options) {
  const InputFile file(path);
  if (file.size_bytes() == 0 || file.size_bytes() % kSplatBytes != 0) {
    throw InputError(fmt::format("{}: got {} bytes, expected records of {} bytes", path,
                                 file.size_bytes(), kSplatBytes));
  }
  const std::string bytes = file.text_from(0, file.size_bytes());
  SceneContents contents = decoded_scene(
      path, bytes.size() / kSplatBytes, 0, options, [&](std::uint64_t index, float* slots) {
        const char* record = &bytes[index * kSplatBytes];
        for (int axis = 0; axis < 3; ++axis) {
          slots[kMeanSlot + axis] = load_number<float>(record + 4 * axis);
          const double scale = load_number<float>(record + kScaleAt + 4 * axis);
          slots[kScaleSlot + axis] = static_cast<float>(std::log(scale));
          const double colour = byte_at(record + kColourAt + axis) / 255.0;
          slots[kDcSlot + axis] = static_cast<float>(dc_of_colour(colour));
        }
        slots[kOpacitySlot] = logit_of_byte(byte_at(record + kOpacityAt));
        decode_splat_rotation(record + kRotationAt, slots + kRotationSlot);
      });
  contents.notes.emplace_back(
      "rotations are read as splat-transform reads them, byte / 127.5 - 1; the form's first viewer "
      "takes byte / 128 - 1");
  return contents;
}

}  // namespace sgs
