// Each loop once as a template, and compiled for several machines for either scalar.
#include "algorithm/tune/row_filter.h"

#include "algorithm/splat/widest_lanes.h"

namespace sgs {
namespace {

template <class T>
[[gnu::always_inline]] inline void across(const T* __restrict in, std::size_t count,
                                          const SsimWindow<T>& window, T* __restrict out) {
  const SsimWindow<T> w = window;
  for (std::size_t i = 0; i < count; ++i) {
    T sum = w[0] * in[i];
    for (std::size_t t = 1; t < kSsimTaps; ++t) sum += w[t] * in[i + 3 * t];
    out[i] = sum;
  }
}

template <class T>
[[gnu::always_inline]] inline void down(const T* const (&rows)[kSsimTaps], std::size_t count,
                                        const SsimWindow<T>& window, T* __restrict out) {
  const SsimWindow<T> w = window;
  const T *const r0 = rows[0], *const r1 = rows[1], *const r2 = rows[2], *const r3 = rows[3],
                 *const r4 = rows[4], *const r5 = rows[5], *const r6 = rows[6], *const r7 = rows[7],
                 *const r8 = rows[8], *const r9 = rows[9], *const r10 = rows[10];
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = w[0] * r0[i] + w[1] * r1[i] + w[2] * r2[i] + w[3] * r3[i] + w[4] * r4[i] +
             w[5] * r5[i] + w[6] * r6[i] + w[7] * r7[i] + w[8] * r8[i] + w[9] * r9[i] +
             w[10] * r10[i];
  }
}

template <class T>
[[gnu::always_inline]] inline void multiply(std::size_t count, const MomentRows<T>& rows) {
  const T* __restrict a = rows.a, * __restrict b = rows.b;
  T* __restrict aa = rows.aa, * __restrict bb = rows.bb, * __restrict ab = rows.ab;
  for (std::size_t i = 0; i < count; ++i) {
    aa[i] = a[i] * a[i];
    bb[i] = b[i] * b[i];
    ab[i] = a[i] * b[i];
  }
}

// S = N1 N2 / (D1 D2), N1 = 2 a b + C1, N2 = 2 (ab - a b) + C2, D1 = a^2 + b^2 + C1,
// D2 = aa + bb - a^2 - b^2 + C2 of the means a, b, aa, bb, ab.
template <class T>
[[gnu::always_inline]] inline void differentiate(std::size_t count, const MomentRows<T>& rows) {
  T* __restrict a = rows.a, * __restrict b = rows.b, * __restrict aa = rows.aa, * __restrict ab = rows.ab;
  const T* __restrict bb = rows.bb;
  const T c1 = T(kSsimC1), c2 = T(kSsimC2), two = T(2), one = T(1);
  for (std::size_t i = 0; i < count; ++i) {
    const T mean_a = a[i], mean_b = b[i];
    const T product = mean_a * mean_b, squares = mean_a * mean_a + mean_b * mean_b;
    const T n1 = two * product + c1, n2 = two * (ab[i] - product) + c2;
    const T d1 = squares + c1, d2 = aa[i] + bb[i] - squares + c2;
    const T inverse = one / (d1 * d2);
    const T similarity = n1 * n2 * inverse;
    a[i] = two * inverse * (mean_b * (n2 - n1) - mean_a * similarity * (d2 - d1));
    b[i] = similarity;
    aa[i] = -similarity * d1 * inverse;
    ab[i] = two * n1 * inverse;
  }
}

}  // namespace

SGS_WIDEST_LANES
void filter_across(const float* in, std::size_t count, const SsimWindow<float>& window,
                   float* out) {
  across(in, count, window, out);
}
SGS_WIDEST_LANES
void filter_across(const double* in, std::size_t count, const SsimWindow<double>& window,
                   double* out) {
  across(in, count, window, out);
}

SGS_WIDEST_LANES
void filter_down(const float* const (&rows)[kSsimTaps], std::size_t count,
                 const SsimWindow<float>& window, float* out) {
  down(rows, count, window, out);
}
SGS_WIDEST_LANES
void filter_down(const double* const (&rows)[kSsimTaps], std::size_t count,
                 const SsimWindow<double>& window, double* out) {
  down(rows, count, window, out);
}

SGS_WIDEST_LANES
void multiply_rows(std::size_t count, const MomentRows<float>& rows) { multiply(count, rows); }
SGS_WIDEST_LANES
void multiply_rows(std::size_t count, const MomentRows<double>& rows) { multiply(count, rows); }

SGS_WIDEST_LANES
void differentiate_similarity(std::size_t count, const MomentRows<float>& rows) {
  differentiate(count, rows);
}
SGS_WIDEST_LANES
void differentiate_similarity(std::size_t count, const MomentRows<double>& rows) {
  differentiate(count, rows);
}

}  // namespace sgs
