// SGS_WIDEST_LANES before a function of loops over lanes: compiled for several machines, the widest
// variant that this one has is picked at run time. Without fused multiply-adds all give the same
// bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SGS_WIDEST_LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define SGS_WIDEST_LANES
#endif
