// Rows of pictures under the SSIM window: loops over the values of a row, three a pixel, written so
// that compilers vectorise them. For float and double.
#pragma once

#include <array>
#include <cstddef>

#include "algorithm/image/quality.h"

namespace sgs {

template <class T>
using SsimWindow = std::array<T, kSsimTaps>;

// Values beside a row that a filter across it reads.
constexpr std::size_t kRowMargin = std::size_t{3} * kSsimRadiusPx;

// out[i] = sum_t window[t] in[i + 3 t]; in: count + 2 kRowMargin values.
void filter_across(const float* in, std::size_t count, const SsimWindow<float>& window, float* out);
void filter_across(const double* in, std::size_t count, const SsimWindow<double>& window,
                   double* out);

// out[i] = sum_t window[t] rows[t][i].
void filter_down(const float* const (&rows)[kSsimTaps], std::size_t count,
                 const SsimWindow<float>& window, float* out);
void filter_down(const double* const (&rows)[kSsimTaps], std::size_t count,
                 const SsimWindow<double>& window, double* out);

// Under the window: means of a, b, a^2, b^2 and a b.
template <class T>
struct MomentRows {
  T *a, *b, *aa, *bb, *ab;
};

// Products of two rows.
void multiply_rows(std::size_t count, const MomentRows<float>& rows);
void multiply_rows(std::size_t count, const MomentRows<double>& rows);

// From moments to the similarity of each value, put into b, and its derivatives by the means of a,
// a^2 and a b, put into a, aa and ab. bb is left.
void differentiate_similarity(std::size_t count, const MomentRows<float>& rows);
void differentiate_similarity(std::size_t count, const MomentRows<double>& rows);

}  // namespace sgs
