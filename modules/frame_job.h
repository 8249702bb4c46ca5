// The registers that the host writes into an accelerator before a frame.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/scene_layout.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/renaming_table.h"

namespace sgs {

// Where a renaming table lies, for a machine that has one; and what the host loads there with the
// scene.
struct RenamingPlace {
  glm::ivec3 cells{0};  // of the box that is numbered
  CellNumbers numbers;
  RenamingLookUp look_up;
  RecordArray records;
  std::shared_ptr<const std::vector<std::byte>> contents;  // null: no such table
};

// What differs from frame to frame: the pose, and where the pixels go.
struct Picture {
  View<float> view{};
  FrameFormat frame_format = FrameFormat::kRgb8;
  RegionSpan frame_buffer;  // rows from the top, pixels without padding

  std::uint64_t pixel_address(int x, int y) const {
    return frame_buffer.base +
           (static_cast<std::uint64_t>(y) * view.width + x) * pixel_bytes(frame_format);
  }
};

// A frame, and those that follow it back to back.
struct FrameJob : Picture {
  glm::vec3 background{0.0F};
  SceneLayout layout;      // the scene's regions, then those that the machine uses
  RegionSpan spill;        // for data that the machine puts aside during the frame; may be empty
  RenamingPlace renaming;  // empty where the machine has no such table
  RegionSpan adjacency;    // for edges that its adjacency table has no room for; may be empty
  // Two eyes: each frame has a picture for the left one and then one for the right one.
  std::uint32_t eyes = 1;
  std::vector<Picture> following;  // behind the first picture, of the same size

  std::uint32_t frames() const { return static_cast<std::uint32_t>(1 + following.size()) / eyes; }
  const Picture& picture(std::uint32_t frame, std::uint32_t eye = 0) const {
    const std::uint32_t at = frame * eyes + eye;
    return at == 0 ? *this : following[at - 1];
  }
  // The job of one of the eyes, as if the other was not there.
  FrameJob of_eye(std::uint32_t eye) const {
    FrameJob out = *this;
    out.eyes = 1;
    out.following.clear();
    for (std::uint32_t frame = 1; frame < frames(); ++frame) {
      out.following.push_back(picture(frame, eye));
    }
    static_cast<Picture&>(out) = picture(0, eye);
    return out;
  }
};

}  // namespace sgs
