// The choice of the format for photograph.h.
#include "algorithm/image/photograph.h"

#include <fmt/format.h>

#include "algorithm/image/jpeg_file.h"
#include "algorithm/image/png_file.h"
#include "algorithm/input_error.h"
#include "algorithm/input_file.h"

namespace sgs {
namespace {

bool is_png(const std::string& path) {
  const std::string head = InputFile(path).text_from(0, 8);
  if (head == "\x89PNG\r\n\x1a\n") return true;
  if (head.compare(0, 2, "\xff\xd8") == 0) return false;
  throw InputError(
      fmt::format("{}: neither begins as a PNG nor as a JPEG, expected one of them", path));
}

}  // namespace

RgbaImage read_photograph(const std::string& path) {
  return is_png(path) ? read_png_rgba(path) : read_jpeg(path);
}

ImageHeader read_photograph_header(const std::string& path) {
  return is_png(path) ? read_png_header(path) : read_jpeg_header(path);
}

}  // namespace sgs
