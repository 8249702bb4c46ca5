// Pictures, meta.json and zip of SOG.
#include <fmt/format.h>
#include <webp/encode.h>
#include <zip.h>

#include <stdexcept>

#include "tests/algorithm/scene_files/made_scene_files.h"

namespace sgs::test {
namespace {

std::string codebook(double step, double first) {
  std::string text;
  for (int k = 0; k < 256; ++k) text += fmt::format("{}{}", k == 0 ? "" : ",", k * step + first);
  return text;
}

// Four samples a Gaussian.
template <class Sample>
std::string picture(std::size_t count, const Sample& sample) {
  std::vector<std::uint8_t> rgba;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) rgba.push_back(static_cast<std::uint8_t>(sample(i, k)));
  }
  return webp_bytes(std::move(rgba), 4);
}

}  // namespace

std::string webp_bytes(std::vector<std::uint8_t> rgba, int width) {
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  rgba.resize((rgba.size() + row - 1) / row * row);
  WebPConfig config;
  WebPConfigInit(&config);
  config.lossless = 1;
  config.exact = 1;
  WebPPicture image;
  WebPPictureInit(&image);
  image.use_argb = 1;
  image.width = width;
  image.height = static_cast<int>(rgba.size() / row);
  WebPPictureImportRGBA(&image, rgba.data(), static_cast<int>(row));
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  image.writer = WebPMemoryWrite;
  image.custom_ptr = &writer;
  if (WebPEncode(&config, &image) == 0) throw std::logic_error("cannot encode WebP");
  std::string bytes(reinterpret_cast<const char*>(writer.mem), writer.size);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&image);
  return bytes;
}

std::vector<Part> sog_parts(std::size_t count, int degree) {
  std::string meta = fmt::format(
      R"({{"version": 2, "count": {},
"means": {{"mins": [-2, -2, -2], "maxs": [2, 2, 2], "files": ["means_l.webp", "means_u.webp"]}},
"scales": {{"codebook": [{}], "files": ["scales.webp"]}},
"quats": {{"files": ["quats.webp"]}},
"sh0": {{"codebook": [{}], "files": ["sh0.webp"]}})",
      count, codebook(1.0 / 64, -5), codebook(1.0 / 128, -1));
  std::vector<Part> parts;
  const auto add = [&](const char* name, auto sample) {
    parts.push_back({name, picture(count, sample)});
  };
  add("means_l.webp", [](auto i, auto k) { return k < 3 ? code(i, k) : 255; });
  add("means_u.webp", [](auto i, auto k) { return k < 3 ? code(i, 3 + k) : 255; });
  add("quats.webp", [](auto i, auto k) { return k < 3 ? code(i, 6 + k) : 252 + i % 4; });
  add("scales.webp", [](auto i, auto k) { return k < 3 ? code(i, 9 + k) : 255; });
  add("sh0.webp", [](auto i, auto k) { return code(i, 12 + k); });
  if (degree > 0) {
    meta += fmt::format(
        R"(, "shN": {{"count": 3, "bands": {}, "codebook": [{}],
"files": ["shN_centroids.webp", "shN_labels.webp"]}})",
        degree, codebook(1.0 / 256, -0.5));
    const int coeffs = rest_count(degree) / 3;
    std::vector<std::uint8_t> palette(256 * static_cast<std::size_t>(coeffs), 0);
    for (std::size_t entry = 0; entry < 3; ++entry) {
      for (int k = 0; k < coeffs; ++k) {
        std::uint8_t* pixel = &palette[4 * (entry * coeffs + k)];
        for (int channel = 0; channel < 3; ++channel) {
          pixel[channel] = static_cast<std::uint8_t>(code(entry, 20 + 3 * k + channel));
        }
        pixel[3] = 255;
      }
    }
    parts.push_back({"shN_centroids.webp", webp_bytes(palette, 64 * coeffs)});
    add("shN_labels.webp", [](auto i, auto k) { return k == 0 ? i % 3 : k == 3 ? 255 : 0; });
  }
  parts.insert(parts.begin(), {"meta.json", meta + "}"});
  return parts;
}

std::string zip_bytes(const std::vector<Part>& parts) {
  zip_error_t error;
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(target);
  zip_t* zip = zip_open_from_source(target, ZIP_TRUNCATE, &error);
  for (const Part& part : parts) {
    zip_source_t* source = zip_source_buffer(zip, part.bytes.data(), part.bytes.size(), 0);
    const zip_int64_t index = zip_file_add(zip, part.name.c_str(), source, 0);
    zip_set_file_compression(zip, static_cast<zip_uint64_t>(index),
                             part.name == "meta.json" ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
    zip_file_set_mtime(zip, static_cast<zip_uint64_t>(index), 315532800, 0);
  }
  if (zip_close(zip) != 0) throw std::logic_error("cannot make a zip");
  zip_source_open(target);
  zip_source_seek(target, 0, SEEK_END);
  std::string bytes(static_cast<std::size_t>(zip_source_tell(target)), '\0');
  zip_source_seek(target, 0, SEEK_SET);
  zip_source_read(target, bytes.data(), bytes.size());
  zip_source_close(target);
  zip_source_free(target);
  return bytes;
}

}  // namespace sgs::test
