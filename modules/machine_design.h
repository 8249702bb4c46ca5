// An accelerator before it is built: what can be chosen about it, what it needs of the scene's
// storage, which picture it must give, and how to build it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/rects.h"
#include "algorithm/storage/stored_scene.h"
#include "modules/auto_choice.h"
#include "modules/config/config_visitor.h"
#include "modules/frame_job.h"
#include "modules/golden_frame.h"
#include "modules/machine.h"
#include "tlm/data_sheet.h"
#include "tlm/stall_injector.h"

namespace sgs {

// Options of building a machine, for tests.
struct BuildOptions {
  StallConfig stalls;  // random waits at both sides of every FIFO
  // A seed of the delta jitter, by which the processes of an instant overtake each other; 0: none.
  // No number of a report may depend on it.
  std::uint64_t jitter_seed = 0;
};

class MachineDesign {
 public:
  virtual ~MachineDesign() = default;

  // Its keys of the configuration.
  virtual void visit(ConfigVisitor& v) = 0;

  // Storage order that scenes must have for it, by its keys.
  virtual StorageOrder storage_order() const = 0;

  // frames(): sizes of the pictures that are going to be drawn, to be called once and only where
  // something follows from them. Before resolve(); not at all where there is no picture.
  virtual void fit_frames(const std::function<std::vector<PixelSize>()>& frames) { (void)frames; }

  // Builds it for frames of two eyes. Before resolve(). False: it draws one eye a frame.
  virtual bool draw_two_eyes() { return false; }

  // Fills in what the configuration left to the model, and adds it to `chosen`. Buffers are built
  // for any scene that is stored so. Throws InputError for what cannot be built; the message shows
  // the arithmetic.
  virtual void resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) = 0;

  // From here on resolve() makes on-chip memories as large as all else needs, once it has decided
  // what their sizes decide. Before resolve(). Returns their keys; codebooks are of the scene.
  virtual std::vector<const char*> fit_memories() { return {}; }

  // As resolve(), once the scene is known. Throws InputError when the scene does not fit.
  virtual void adapt(const SecondHalfFormat& format, std::vector<AutoChoice>& chosen) = 0;

  // The registers of a frame; regions that the frame writes stand behind the scene's.
  virtual FrameJob job(const StoredScene& scene, const Camera& camera) const = 0;

  // The same of frames back to back, all of one size: they take two frame buffers in turn.
  FrameJob stream(const StoredScene& scene, const std::vector<Camera>& cameras) const;

  // The frame that the machine must render of this job, the first of its frames. Whatever else its
  // golden renderer knows belongs to this machine alone: published in `sheet`, by name, as
  // operations that the frame left out.
  virtual GoldenFrame golden(const StoredScene& scene, const FrameJob& job,
                             DataSheet& sheet) const = 0;

  // All of the configuration that the frame of golden() follows from, as a text: designs of one
  // machine and one text draw the same, and count the same of it. Empty: that is not known.
  virtual std::string golden_key() const { return {}; }

  // Properties that scenes can be tuned for: how it renders, where that is in paper order; whether
  // it draws the reference picture of a stored scene, bit for bit; the group of pixels that a
  // Gaussian is fetched for, 0 x 0 where there are none.
  virtual std::optional<PaperOrderConfig> paper_order() const { return {}; }
  virtual bool draws_reference() const { return false; }
  virtual PixelSize group() const { return {}; }

  // Size of the piece that it draws at a time, by which activities are numbered in rows from the
  // top: that group, or a tile. 0 x 0 where there is no such thing.
  virtual PixelSize piece() const { return group(); }

  // Area that its configuration says is published, mm2 of units and on-chip memories; 0: none.
  virtual double stated_area_mm2() const { return 0; }

  virtual std::unique_ptr<Machine> build(const sc_core::sc_module_name& name, const FrameJob& job,
                                         const BuildOptions& options) const = 0;
};

inline void visit(ConfigVisitor& v, MachineDesign& design) { design.visit(v); }

// Adds the frame buffer behind the regions that the job has; where its view is of the left one of
// two eyes also the right one's picture, with a buffer of its own.
void add_frame_buffers(FrameJob& job);

// Throws InputError where a machine of so many eyes cannot draw what the camera sees.
void check_eyes(std::uint32_t eyes, const Camera& camera);

// A line of the factory.
struct MachineKind {
  const char* name;     // value of the configuration's key `machine`
  const char* summary;  // for --help
  std::unique_ptr<MachineDesign> (*design)();
};

}  // namespace sgs
