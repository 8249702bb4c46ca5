// The schemes there are; storage_scheme.h tells which is of which order.
#pragma once

namespace sgs {

class StorageScheme;

const StorageScheme& voxel_scheme();
const StorageScheme& chunk_scheme();
const StorageScheme& file_scheme();

}  // namespace sgs
