// Reading of image_formats.h with libjpeg. It reports errors by longjmp: the functions that call
// setjmp hold nothing that has a destructor.
#include <csetjmp>
#include <cstdio>

#include "algorithm/image/image_formats.h"
// libjpeg's headers want <cstdio> before them.
#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

struct JpegErrors {
  jpeg_error_mgr base;  // first: libjpeg knows no more than this
  std::jmp_buf place;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void leave(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  (*info->err->format_message)(info, errors->message);
  std::longjmp(errors->place, 1);
}

// Damage that libjpeg would repair by guessing (level -1) is an error here, but for bytes between
// segments that mean nothing.
void leave_on_damage(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) leave(info);
}

class JpegReader {
 public:
  // `bytes` must outlive the reader.
  explicit JpegReader(const std::string& bytes) : bytes_(bytes) {
    info_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = leave;
    errors_.base.emit_message = leave_on_damage;
    errors_.message[0] = '\0';
  }
  ~JpegReader() { jpeg_destroy_decompress(&info_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  // False where message() says what is wrong.
  bool read_header() {
    if (setjmp(errors_.place) != 0) return false;
    jpeg_create_decompress(&info_);
    jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(bytes_.data()),
                 static_cast<unsigned long>(bytes_.size()));
    jpeg_read_header(&info_, TRUE);
    return true;
  }

  // rows: 3 bytes a pixel. After read_header(); false as there.
  bool read_pixels(std::uint8_t* rows) {
    if (setjmp(errors_.place) != 0) return false;
    info_.out_color_space = JCS_RGB;
    jpeg_start_decompress(&info_);
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = rows + std::size_t{3} * info_.output_scanline * info_.output_width;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return true;
  }

  const char* message() const { return errors_.message; }
  std::uint64_t width() const { return info_.image_width; }
  std::uint64_t height() const { return info_.image_height; }
  int components() const { return info_.num_components; }

 private:
  const std::string& bytes_;
  jpeg_decompress_struct info_{};
  JpegErrors errors_;
};

[[noreturn]] void refuse(const std::string& path, const JpegReader& jpeg) {
  throw InputError(fmt::format("{}: {}, expected a JPEG image", path, jpeg.message()));
}

ImageHeader checked_header(const std::string& path, const JpegReader& jpeg,
                           std::uint64_t file_bytes) {
  // A block of 8x8 pixels takes a bit or more, so a longer promise is a damaged header.
  constexpr std::uint64_t kMostPixelsByte = 8 * 64;
  if (jpeg.components() != 1 && jpeg.components() != 3) {
    throw InputError(fmt::format("{}: got {} colour components, expected 1 (grey) or 3", path,
                                 jpeg.components()));
  }
  if (jpeg.width() * jpeg.height() > kMostPixelsByte * file_bytes) {
    throw InputError(fmt::format("{}: got {} bytes, expected {}x{} pixels", path, file_bytes,
                                 jpeg.width(), jpeg.height()));
  }
  return {static_cast<int>(jpeg.width()), static_cast<int>(jpeg.height()), false};
}

}  // namespace

RgbaImage read_jpeg(const std::string& path) {
  const InputFile file(path);
  const std::string bytes = file.text_from(0, file.size_bytes());
  JpegReader jpeg(bytes);
  if (!jpeg.read_header()) refuse(path, jpeg);
  const ImageHeader header = checked_header(path, jpeg, bytes.size());
  RgbaImage image(header.width, header.height);
  std::vector<std::uint8_t> rgb(3 * image.pixels.size());
  if (!jpeg.read_pixels(rgb.data())) refuse(path, jpeg);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* p = &rgb[3 * i];
    image.pixels[i] = glm::vec4(glm::vec3(p[0], p[1], p[2]) / 255.0f, 1.0f);
  }
  return image;
}

ImageHeader read_jpeg_header(const std::string& path) {
  constexpr std::uint64_t kUsualHeaderBytes = 1 << 16;  // previews and profiles may make it longer
  constexpr std::uint64_t kMostHeaderBytes = 1 << 26;
  const InputFile file(path);
  {
    const std::string head = file.text_from(0, kUsualHeaderBytes);
    JpegReader jpeg(head);
    if (jpeg.read_header()) return checked_header(path, jpeg, file.size_bytes());
  }
  const std::string head = file.text_from(0, kMostHeaderBytes);
  JpegReader jpeg(head);
  if (!jpeg.read_header()) refuse(path, jpeg);
  return checked_header(path, jpeg, file.size_bytes());
}

}  // namespace sgs
