// The conservative test of a chunk's bound against a pixel group, in float.
#include "algorithm/voxel/chunk_test.h"

namespace sgs {

template class GroupFrustumOf<float>;

}  // namespace sgs
