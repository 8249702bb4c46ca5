// Three passes over the rows, each row by itself: moments filtered across; down, similarity, its
// derivatives filtered across; those down, and back to pixels. The window is its own mirror image,
// so what a mean says of its pixels is filtered as the pixels were.
#include "algorithm/tune/photometric_loss.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "algorithm/image/quality.h"
#include "algorithm/tune/row_filter.h"

namespace sgs {
namespace {

// Several pictures' values, row by row.
template <class T>
class RowStore {
 public:
  RowStore(std::size_t planes, std::size_t height, std::size_t row_values)
      : height_(height), row_values_(row_values), values_(planes * height * row_values) {}
  T* row(std::size_t plane, std::size_t y) { return &values_[(plane * height_ + y) * row_values_]; }

 private:
  std::size_t height_, row_values_;
  std::vector<T> values_;
};

template <class T>
SsimWindow<T> window_of() {
  const auto window = ssim_window();
  SsimWindow<T> out;
  std::copy(window.begin(), window.end(), out.begin());
  return out;
}

// Beside a row of `count` values there is nothing: zeros.
template <class T>
class PaddedRows {
 public:
  PaddedRows(std::size_t rows, std::size_t count)
      : stride_(count + 2 * kRowMargin), values_(rows * stride_) {}
  T* whole(std::size_t row) { return &values_[row * stride_]; }
  T* inner(std::size_t row) { return whole(row) + kRowMargin; }
  MomentRows<T> moments() { return {whole(0), whole(1), whole(2), whole(3), whole(4)}; }
  std::size_t stride() const { return stride_; }

 private:
  std::size_t stride_;
  std::vector<T> values_;
};

template <class T>
class LossPasses {
 public:
  LossPasses(const T* picture, const T* target, int width_px, int height_px)
      : picture_(picture),
        target_(target),
        height_(static_cast<std::size_t>(height_px)),
        count_(3 * static_cast<std::size_t>(width_px)),
        window_(window_of<T>()),
        zeros_(count_),
        moments_(5, height_, count_),
        derivatives_(3, height_, count_),
        l1_(height_),
        ssim_(height_) {}

  PhotometricLoss<T> run(double lambda) {
    const auto values = static_cast<double>(count_ * height_);
    PhotometricLoss<T> out{0, 0, 0, std::vector<T>(count_ * height_)};
    const T by_similarity = T(-lambda / values), by_difference = T((1 - lambda) / values);
    const auto each_row = [&](const auto& pass) {
      tbb::parallel_for(std::size_t{0}, height_, pass);
    };
    each_row([&](std::size_t y) { filter_moments(y); });
    each_row([&](std::size_t y) { differentiate(y); });
    each_row([&](std::size_t y) {
      write_gradient(y, by_similarity, by_difference, &out.gradient[y * count_]);
    });
    out.l1 = std::accumulate(l1_.begin(), l1_.end(), 0.0) / values;
    out.ssim = std::accumulate(ssim_.begin(), ssim_.end(), 0.0) / values;
    out.loss = (1 - lambda) * out.l1 + lambda * (1 - out.ssim);
    return out;
  }

 private:
  void filter_moments(std::size_t y) {
    PaddedRows<T> rows(5, count_);
    std::copy_n(picture_ + y * count_, count_, rows.inner(0));
    std::copy_n(target_ + y * count_, count_, rows.inner(1));
    multiply_rows(rows.stride(), rows.moments());
    for (std::size_t k = 0; k < 5; ++k) {
      filter_across(rows.whole(k), count_, window_, moments_.row(k, y));
    }
  }

  void differentiate(std::size_t y) {
    PaddedRows<T> rows(5, count_);
    for (std::size_t k = 0; k < 5; ++k) filter_plane_down(moments_, k, y, rows.inner(k));
    differentiate_similarity(
        count_, {rows.inner(0), rows.inner(1), rows.inner(2), rows.inner(3), rows.inner(4)});
    ssim_[y] = std::accumulate(rows.inner(1), rows.inner(1) + count_, 0.0);
    const std::size_t by_means[] = {0, 2, 4};  // derivatives by the means of a, a^2 and a b
    for (std::size_t k = 0; k < 3; ++k) {
      filter_across(rows.whole(by_means[k]), count_, window_, derivatives_.row(k, y));
    }
  }

  void write_gradient(std::size_t y, T by_similarity, T by_difference, T* gradient) {
    PaddedRows<T> rows(3, count_);
    for (std::size_t k = 0; k < 3; ++k) filter_plane_down(derivatives_, k, y, rows.inner(k));
    const T *by_a = rows.inner(0), *by_aa = rows.inner(1), *by_ab = rows.inner(2);
    const T *a = picture_ + y * count_, *b = target_ + y * count_;
    double l1 = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const T difference = a[i] - b[i];
      l1 += std::abs(difference);
      const T sign = T(difference > T(0)) - T(difference < T(0));
      gradient[i] = by_similarity * (by_a[i] + T(2) * a[i] * by_aa[i] + b[i] * by_ab[i]) +
                    by_difference * sign;
    }
    l1_[y] = l1;
  }

  // The rows around y that the window holds; above and below the picture rows of zeros.
  void filter_plane_down(RowStore<T>& store, std::size_t plane, std::size_t y, T* out) {
    const T* rows[kSsimTaps];
    for (std::size_t t = 0; t < kSsimTaps; ++t) {
      const std::size_t at = y + t - kSsimRadiusPx;  // wraps around above the picture
      rows[t] = at < height_ ? store.row(plane, at) : zeros_.data();
    }
    filter_down(rows, count_, window_, out);
  }

  const T *picture_, *target_;
  const std::size_t height_, count_;  // rows; values of a row
  const SsimWindow<T> window_;
  const std::vector<T> zeros_;
  RowStore<T> moments_;            // under the window across
  RowStore<T> derivatives_;        // derivatives of SSIM by the means, under the window across
  std::vector<double> l1_, ssim_;  // sums over each row
};

}  // namespace

template <class T>
PhotometricLoss<T> photometric_loss(const T* picture, const T* target, int width_px, int height_px,
                                    double lambda) {
  return LossPasses<T>(picture, target, width_px, height_px).run(lambda);
}

template PhotometricLoss<float> photometric_loss(const float*, const float*, int, int, double);
template PhotometricLoss<double> photometric_loss(const double*, const double*, int, int, double);

ImageLoss photometric_loss(const Image& picture, const Image& target, double lambda) {
  check_same_size(picture, target);
  const PhotometricLoss<float> loss = photometric_loss(&picture.pixels[0].x, &target.pixels[0].x,
                                                       picture.width, picture.height, lambda);
  ImageLoss out{loss.loss, loss.l1, loss.ssim, Image(picture.width, picture.height)};
  std::copy(loss.gradient.begin(), loss.gradient.end(), &out.gradient.pixels[0].x);
  return out;
}

}  // namespace sgs
