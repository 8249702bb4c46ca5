// Reading of a scene out of its image.
#include "algorithm/storage/restore_scene.h"

#include <utility>

#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/storage_scheme.h"

namespace sgs {

StoredScene restore_scene(PackedScene packed, const std::string& source) {
  StoredScene out;
  out.gaussians = packed.facts.gaussians;
  out.decoded = decode_image(packed.image, source);
  out.table = scheme_of(packed.storage.order).restore(packed, out.decoded, source);
  out.storage = packed.storage;
  out.sh_bands_left_out = packed.facts.sh_bands_left_out;
  out.sh_error = out.sh_bands_left_out > 0 ? packed.storage.sh_tolerance : 0;  // at most
  out.image = std::move(packed.image);
  return out;
}

}  // namespace sgs
