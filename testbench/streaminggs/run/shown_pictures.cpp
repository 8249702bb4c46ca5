// Reads and writes at a place: parent and child share the file's position.
#include "testbench/streaminggs/run/shown_pictures.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace sgs {
namespace {

[[noreturn]] void fail_to(const char* what) {
  throw std::runtime_error(fmt::format("pictures of the stream: cannot {} a temporary file: {}",
                                       what, std::strerror(errno)));
}

// transfer(done): moves bytes behind those that are done; returns how many, -1 with errno.
template <class Transfer>
void transfer_all(std::size_t bytes, const char* what, const Transfer& transfer) {
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t moved = transfer(done);
    if (moved < 0 && errno == EINTR) continue;
    if (moved == 0) errno = EIO;
    if (moved <= 0) fail_to(what);
    done += static_cast<std::size_t>(moved);
  }
}

}  // namespace

ShownPictures::ShownPictures(const FrameJob& job) : job_(job), file_(std::tmpfile(), std::fclose) {
  if (file_ == nullptr) fail_to("make");
}

std::uint64_t ShownPictures::place(std::uint32_t frame, std::uint32_t eye) const {
  return (std::uint64_t{frame} * job_.eyes + eye) * job_.frame_buffer.bytes;
}

void ShownPictures::write(std::uint32_t frame, std::uint32_t eye, const std::byte* bytes) {
  const std::uint64_t at = place(frame, eye);
  transfer_all(job_.frame_buffer.bytes, "write", [&](std::size_t done) {
    return ::pwrite(::fileno(file_.get()), bytes + done, job_.frame_buffer.bytes - done,
                    static_cast<off_t>(at + done));
  });
}

std::vector<std::byte> ShownPictures::read(std::uint32_t frame, std::uint32_t eye) const {
  std::vector<std::byte> bytes(job_.frame_buffer.bytes);
  const std::uint64_t at = place(frame, eye);
  transfer_all(bytes.size(), "read", [&](std::size_t done) {
    return ::pread(::fileno(file_.get()), bytes.data() + done, bytes.size() - done,
                   static_cast<off_t>(at + done));
  });
  return bytes;
}

}  // namespace sgs
