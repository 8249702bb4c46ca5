// Chunks, places and types of gltf_buffers.h.
#include "algorithm/scene_files/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/files/input_json.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/scene_files/stored_bytes.h"

namespace sgs {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 53;  // what JSON numbers hold exactly
constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                        kUnsignedInt = 5125, kFloat = 5126;

std::uint64_t bytes_of_type(std::uint32_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double number_at(const char* bytes, bool normalised) {
  const auto value = static_cast<double>(load_number<T>(bytes));
  return normalised ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

// Of the characters of base64 up to its padding; throws InputError for others.
std::string from_base64(const std::string& origin, std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) {
      throw InputError(fmt::format("{}: got \"{}\" in base64, expected its digits", origin, c));
    }
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    have += 6;
    if (have < 8) continue;
    have -= 8;
    bytes += static_cast<char>(bits >> have & 0xffU);
  }
  return bytes;
}

}  // namespace

double GltfAccessor::at(std::uint64_t index, int component) const {
  const char* number =
      bytes + index * stride_bytes + static_cast<std::uint64_t>(component) * bytes_of_type(type);
  switch (type) {
    case kByte:
      return number_at<std::int8_t>(number, normalised);
    case kUnsignedByte:
      return number_at<std::uint8_t>(number, normalised);
    case kShort:
      return number_at<std::int16_t>(number, normalised);
    case kUnsignedShort:
      return number_at<std::uint16_t>(number, normalised);
    case kUnsignedInt:
      return number_at<std::uint32_t>(number, normalised);
    default:
      return number_at<float>(number, false);
  }
}

GltfBuffers::GltfBuffers(const std::string& path) : path_(path), files_{path} {
  const InputFile file(path);
  file_ = file.text_from(0, file.size_bytes());
  if (file_.compare(0, 4, "glTF") == 0) {
    read_glb();
  } else {
    json_ = parse_json(file_, path);
  }
  root_.emplace(path_, json_);
  const JsonPlace version = root_->at("asset").at("version");
  if (version.text() != "2.0") version.refuse("\"2.0\"");
  const std::uint64_t buffer_count = count("buffers");
  for (std::uint64_t i = 0; i < buffer_count; ++i) buffers_.push_back(buffer_bytes(i));
}

void GltfBuffers::read_glb() {
  constexpr std::uint64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  const auto check = [this](bool holds, const std::string& got, const char* expected) {
    if (!holds) throw InputError(fmt::format("{}: got {}, expected {}", path_, got, expected));
  };
  check(file_.size() >= kHeaderBytes + kChunkHeaderBytes, fmt::format("{} bytes", file_.size()),
        "the header of a .glb");
  const auto word = [this](std::uint64_t at) { return load_number<std::uint32_t>(&file_[at]); };
  check(word(4) == 2, fmt::format("version {} of .glb", word(4)), "2");
  check(word(8) == file_.size(), fmt::format("{} bytes", file_.size()),
        "as many as the header of the .glb states");
  bool has_json = false;
  for (std::uint64_t at = kHeaderBytes; at < file_.size();) {
    check(
        file_.size() - at >= kChunkHeaderBytes && word(at) <= file_.size() - at - kChunkHeaderBytes,
        fmt::format("a chunk at byte {} that ends behind the file", at), "whole chunks");
    const std::string_view chunk(&file_[at + kChunkHeaderBytes], word(at));
    if (word(at + 4) == kJson && !has_json) {
      json_ = parse_json(std::string(chunk), path_);
      has_json = true;
    } else if (word(at + 4) == kBinary && binary_.empty()) {
      binary_ = chunk;
    }
    at += kChunkHeaderBytes + chunk.size();
  }
  check(has_json, "a .glb without JSON", "it in the first chunk");
}

std::string_view GltfBuffers::buffer_bytes(std::uint64_t index) {
  const JsonPlace buffer = item("buffers", index);
  const std::uint64_t size = buffer.at("byteLength").whole(0, kMostBytes);
  std::string_view bytes = binary_;
  if (buffer.has("uri")) {
    const std::string uri = buffer.at("uri").text();
    const std::size_t base64 = uri.find(";base64,");
    if (uri.compare(0, 5, "data:") == 0 && base64 != std::string::npos) {
      others_.push_back(from_base64(buffer.name(), std::string_view(uri).substr(base64 + 8)));
    } else {
      others_.push_back(open_folder_of(path_)->bytes(uri));
      files_.push_back((std::filesystem::path(path_).parent_path() / uri).string());
    }
    bytes = others_.back();
  }
  if (bytes.size() < size) {
    buffer.at("byteLength")
        .refuse(fmt::format("at most the {} bytes that are there", bytes.size()));
  }
  return bytes.substr(0, size);
}

std::uint64_t GltfBuffers::count(const std::string& name) const {
  const auto list = root_->find(name);
  if (!list) return 0;
  if (!list->json().is_array()) list->refuse("a list");
  return list->json().size();
}

JsonPlace GltfBuffers::item(const std::string& name, std::uint64_t index) const {
  if (index >= count(name)) {
    throw InputError(fmt::format("{}: got {} {}, expected at most {}", path_, name, index,
                                 count(name) == 0 ? "none" : std::to_string(count(name) - 1)));
  }
  return {fmt::format("{}: {} {}", path_, name, index), root_->at(name).json()[index]};
}

std::string_view GltfBuffers::view(std::uint64_t index) const {
  const JsonPlace view = item("bufferViews", index);
  if (view.has("extensions")) {
    view.at("extensions").refuse("none: write the file without compression of its buffers");
  }
  const std::uint64_t buffer = view.at("buffer").whole();
  item("buffers", buffer);
  const std::string_view bytes = buffers_[buffer];
  const std::uint64_t offset = view.whole_or("byteOffset", 0, kMostBytes);
  const std::uint64_t size = view.at("byteLength").whole(0, kMostBytes);
  if (offset > bytes.size() || size > bytes.size() - offset) {
    view.at("byteLength")
        .refuse(fmt::format("at most what buffer {} of {} bytes has from byte {} on", buffer,
                            bytes.size(), offset));
  }
  return bytes.substr(offset, size);
}

GltfAccessor GltfBuffers::accessor(std::uint64_t index, int components) const {
  const JsonPlace accessor = item("accessors", index);
  if (accessor.has("sparse")) accessor.at("sparse").refuse("none: write the file without it");
  const std::string type = components == 1 ? "SCALAR" : fmt::format("VEC{}", components);
  if (accessor.at("type").text() != type) accessor.at("type").refuse(type);
  GltfAccessor found;
  found.count = accessor.at("count").whole();
  found.components = components;
  found.type = static_cast<std::uint32_t>(accessor.at("componentType").whole());
  found.normalised = accessor.has("normalized") && accessor.at("normalized").flag();
  const std::uint64_t size = static_cast<std::uint64_t>(components) * bytes_of_type(found.type);
  if (size == 0) accessor.at("componentType").refuse("5120 to 5123, 5125 or 5126");
  const std::uint64_t view_index = accessor.at("bufferView").whole();
  const std::string_view bytes = view(view_index);
  found.stride_bytes = item("bufferViews", view_index).whole_or("byteStride", size);
  const std::uint64_t offset = accessor.whole_or("byteOffset", 0, kMostBytes);
  const std::uint64_t left = offset <= bytes.size() ? bytes.size() - offset : 0;
  const bool fits =
      found.stride_bytes >= size &&
      (found.count == 0 || (left >= size && (left - size) / found.stride_bytes >= found.count - 1));
  if (!fits) {
    accessor.at("count").refuse(
        fmt::format("as many as buffer view {} of {} bytes holds", view_index, bytes.size()));
  }
  found.bytes = bytes.data() + offset;
  return found;
}

}  // namespace sgs
