// Blocks and line ends of line_reader.h.
#include "algorithm/line_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/input_error.h"

namespace sgs {

bool LineReader::next(std::string_view& line) {
  constexpr std::size_t kBlockBytes = 1 << 18;
  static_assert(kBlockBytes > kMostLineBytes, "a block holds at least a line");
  std::size_t end = block_.find('\n', position_);
  if (end == std::string::npos && offset_bytes_ < file_.size_bytes()) {
    const std::string more = file_.text_from(offset_bytes_, kBlockBytes);
    offset_bytes_ += more.size();
    block_.erase(0, position_);
    block_ += more;
    position_ = 0;
    end = block_.find('\n');
  }
  if (end == std::string::npos) end = block_.size();
  ++line_number_;
  if (position_ == block_.size()) return false;
  if (end - position_ > kMostLineBytes) {
    throw InputError(fmt::format("{}: line {}: longer than {} bytes, expected a shorter one",
                                 file_.path(), line_number_, kMostLineBytes));
  }
  line = std::string_view(block_).substr(position_, end - position_);
  position_ = std::min(end + 1, block_.size());
  return true;
}

}  // namespace sgs
