// Keys of the voxel sorting unit, paper order.
#include "modules/streaminggs/vsu/paper_vsu_config.h"

namespace sgs {

void visit(ConfigVisitor& v, PaperVsuConfig& c) {
  v("rays_in_flight", c.rays_in_flight, in_range(1, 1024), "rays that are followed side by side");
  v("chain_entries", c.chain_entries, in_range(1, 1024),
    "voxels that a ray keeps until those of the rays before it are in the ordering table");
  v("step_lanes", c.step_lanes, in_range(1, 10000), "MAC lanes of the rays' steps");
  v("ray_lanes", c.ray_lanes, in_range(1, 10000), "MAC lanes of the rays' beginnings");
  v("step_depth_cycles", c.step_depth_cycles, in_range(0, 1000),
    "until a ray can step again; 0: by its schedule");
  v("cell_step_depth_cycles", c.cell_step_depth_cycles, in_range(0, 1000),
    "the same of a step out of a single cell; 0: by its schedule");
  v("ray_depth_cycles", c.ray_depth_cycles, in_range(0, 1000),
    "until a ray that begins is there; 0: by its schedule");
  v("table_banks", c.table_banks, in_range(1, 64),
    "of the ordering table: of each a record a cycle is read and one written");
  v("ray_step_px", c.ray_step_px, in_range(1, 1024),
    "rays of every so-many-th pixel of a group are followed, and of its last row and column");
  v("sample_step_voxels", c.sample_step_voxels, in_range(0, 10),
    "distance of samples on a ray; 0: every cell is visited");
  v("groups_ahead", c.groups_ahead, in_range(1, 64),
    "lists of ordered voxels, in the making or being handed out");
  v("table_bytes", c.table_bytes, in_range(kTableWordBytes, 1 << 30),
    "ordering table of one group; one that needs more is ordered in passes");
  v("node_cache_bytes", c.node_cache_bytes, in_range(64, 1 << 30), "cache of tree nodes");
  v("node_fetches", c.node_fetches, in_range(1, 1024),
    "lines of tree nodes on their way from DRAM");
  v("record_cache_bytes", c.record_cache_bytes, in_range(64, 1 << 30), "cache of voxel records");
  v("cut_cache_bytes", c.cut_cache_bytes, in_range(64, 1 << 30), "cache of cut voxels' planes");
  v("visit_gaussians", c.visit_gaussians, in_range(0, 1 << 30),
    "voxels with more are cut into pieces, each a visit; 0: never");
  v("min_share", c.min_share, in_range(2, 1 << 20), "fewest Gaussians of a visit for one HFU");
}

}  // namespace sgs
