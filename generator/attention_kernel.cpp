#include "generator/attention_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

// Helpers are always inlined into functions of one instruction set: nothing is
// passed in vector registers between functions.
#pragma GCC diagnostic ignored "-Wpsabi"
#define REMOMASK_INLINE inline __attribute__((always_inline))

namespace remomask::generator {

namespace {

constexpr int64_t kLaneWidth = 16;
using Lane = float __attribute__((vector_size(64), aligned(4), may_alias));
using IntLane = int32_t __attribute__((vector_size(64), aligned(4), may_alias));

REMOMASK_INLINE Lane load_lane(const float* p) { return *reinterpret_cast<const Lane*>(p); }
REMOMASK_INLINE void store_lane(float* p, const Lane& x) { *reinterpret_cast<Lane*>(p) = x; }

/// Four rows by `kLanes` lanes of c = a b; a has strides (row, column).
template <int kLanes>
REMOMASK_INLINE void multiply_tile(int64_t inner, const float* a, int64_t a_row, int64_t a_column,
                                   const float* b, int64_t b_row, float* c, int64_t c_row) {
  Lane sum[4][kLanes] = {};
  for (int64_t i = 0; i < inner; ++i) {
    Lane right[kLanes];
    for (int l = 0; l < kLanes; ++l) right[l] = load_lane(b + i * b_row + l * kLaneWidth);
    for (int r = 0; r < 4; ++r) {
      const float left = a[r * a_row + i * a_column];
      for (int l = 0; l < kLanes; ++l) sum[r][l] += left * right[l];
    }
  }
  for (int r = 0; r < 4; ++r) {
    for (int l = 0; l < kLanes; ++l) store_lane(c + r * c_row + l * kLaneWidth, sum[r][l]);
  }
}

/// c [rows, columns] = a b; rows a multiple of 4, columns of 16.
template <int kLanes>
REMOMASK_INLINE void multiply(int64_t rows, int64_t columns, int64_t inner, const float* a,
                              int64_t a_row, int64_t a_column, const float* b, int64_t b_row,
                              float* c, int64_t c_row) {
  int64_t column = 0;
  for (; column + kLanes * kLaneWidth <= columns; column += kLanes * kLaneWidth) {
    for (int64_t row = 0; row < rows; row += 4) {
      multiply_tile<kLanes>(inner, a + row * a_row, a_row, a_column, b + column, b_row,
                            c + row * c_row + column, c_row);
    }
  }
  for (; column < columns; column += kLaneWidth) {
    for (int64_t row = 0; row < rows; row += 4) {
      multiply_tile<1>(inner, a + row * a_row, a_row, a_column, b + column, b_row,
                       c + row * c_row + column, c_row);
    }
  }
}

/// exp for x <= 0, relative error below 2e-7 (range reduction and polynomial of Cephes).
REMOMASK_INLINE Lane exp_lane(Lane x) {
  constexpr float kMagic = 12582912.f;  // 1.5 * 2^23: adding it rounds to an integer
  x = x < -87.f ? Lane{} - 87.f : x;
  const Lane shifted = x * 1.44269504088896341f + kMagic;
  const Lane whole = shifted - kMagic;
  const Lane r = (x - whole * 0.693359375f) - whole * -2.12194440e-4f;
  Lane p = r * 1.9875691500e-4f + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = p * (r * r) + r + 1.f;
  IntLane exponent;
  std::memcpy(&exponent, &shifted, sizeof exponent);
  exponent = (exponent - 0x4B400000 + 127) << 23;
  Lane power;
  std::memcpy(&power, &exponent, sizeof power);
  return p * power;
}

REMOMASK_INLINE float lane_sum(const Lane& x) {
  float sum = 0;
  for (int i = 0; i < kLaneWidth; ++i) sum += x[i];
  return sum;
}

/// Copies rows into [padded_rows, padded_width], zeros around, times `scale`.
REMOMASK_INLINE float* pack_rows(ConstRows rows, int64_t count, int64_t width, int64_t padded_rows,
                                 int64_t padded_width, float scale, float* out) {
  std::fill(out, out + padded_rows * padded_width, 0.f);
  for (int64_t i = 0; i < count; ++i) {
    for (int64_t c = 0; c < width; ++c) {
      out[i * padded_width + c] = scale * rows.data[i * rows.stride + c];
    }
  }
  return out + padded_rows * padded_width;
}

/// The same transposed: [padded_width, padded_rows].
REMOMASK_INLINE float* pack_columns(ConstRows rows, int64_t count, int64_t width,
                                    int64_t padded_rows, int64_t padded_width, float* out) {
  std::fill(out, out + padded_rows * padded_width, 0.f);
  for (int64_t i = 0; i < count; ++i) {
    for (int64_t c = 0; c < width; ++c) {
      out[c * padded_rows + i] = rows.data[i * rows.stride + c];
    }
  }
  return out + padded_rows * padded_width;
}

REMOMASK_INLINE void unpack_rows(const float* packed, int64_t count, int64_t width,
                                 int64_t padded_width, float scale, Rows out) {
  for (int64_t i = 0; i < count; ++i) {
    for (int64_t c = 0; c < width; ++c) {
      out.data[i * out.stride + c] = scale * packed[i * padded_width + c];
    }
  }
}

/// One row of logits becomes the softmax with its biases.
REMOMASK_INLINE void softmax_row(const HeadShape& shape, const float* position, const float* key,
                                 float* row) {
  const int64_t padded = shape.padded_keys();
  if (position != nullptr) {
    for (int64_t j = 0; j < shape.queries; ++j) row[j] += position[j];
  }
  for (int64_t j = 0; j < shape.keys; ++j) row[j] += key[j];
  for (int64_t j = shape.keys; j < padded; ++j) row[j] = -1e30f;
  Lane most = load_lane(row);
  for (int64_t j = kLaneWidth; j < padded; j += kLaneWidth) {
    const Lane x = load_lane(row + j);
    most = x > most ? x : most;
  }
  float largest = most[0];
  for (int i = 1; i < kLaneWidth; ++i) largest = std::max(largest, most[i]);
  Lane sum = {};
  for (int64_t j = 0; j < padded; j += kLaneWidth) {
    const Lane x = load_lane(row + j) - largest;
    // Exactly zero far down: hidden keys have no weight at all.
    const Lane e = x < -87.f ? Lane{} : exp_lane(x);
    store_lane(row + j, e);
    sum += e;
  }
  const float inverse = 1.f / lane_sum(sum);
  for (int64_t j = 0; j < padded; j += kLaneWidth) {
    store_lane(row + j, load_lane(row + j) * inverse);
  }
}

template <int kLanes>
REMOMASK_INLINE void forward_body(const HeadShape& shape, ConstRows q, ConstRows k, ConstRows v,
                                  const float* position, const float* key, float* weights, Rows out,
                                  float* scratch) {
  const int64_t n = shape.padded_queries(), m = shape.padded_keys(), d = shape.padded_width();
  float* const queries = scratch;
  float* const keys = pack_rows(q, shape.queries, shape.width, n, d,
                                1.f / std::sqrt(static_cast<float>(shape.width)), queries);
  float* const values = pack_columns(k, shape.keys, shape.width, m, d, keys);
  float* const result = pack_rows(v, shape.keys, shape.width, m, d, 1.f, values);
  multiply<kLanes>(n, m, d, queries, d, 1, keys, m, weights, m);
  for (int64_t i = 0; i < n; ++i) {
    softmax_row(shape, i < shape.queries ? position + i * shape.queries : nullptr, key,
                weights + i * m);
  }
  multiply<kLanes>(n, d, m, weights, m, 1, values, d, result, d);
  unpack_rows(result, shape.queries, shape.width, d, 1.f, out);
}

template <int kLanes>
REMOMASK_INLINE void backward_body(const HeadShape& shape, ConstRows grad_out, ConstRows q,
                                   ConstRows k, ConstRows v, const float* weights, Rows grad_q,
                                   Rows grad_k, Rows grad_v, float* grad_position, float* grad_key,
                                   float* scratch) {
  const int64_t n = shape.padded_queries(), m = shape.padded_keys(), d = shape.padded_width();
  const float scale = 1.f / std::sqrt(static_cast<float>(shape.width));
  float* const grad = scratch;
  float* const values = pack_rows(grad_out, shape.queries, shape.width, n, d, 1.f, grad);
  float* const queries = pack_columns(v, shape.keys, shape.width, m, d, values);
  float* const keys = pack_rows(q, shape.queries, shape.width, n, d, scale, queries);
  float* const logits = pack_rows(k, shape.keys, shape.width, m, d, 1.f, keys);
  float* const result = logits + n * m;

  multiply<kLanes>(n, m, d, grad, d, 1, values, m, logits, m);
  for (int64_t i = 0; i < n; ++i) {
    float* const row = logits + i * m;
    const float* const weight = weights + i * m;
    Lane sum = {};
    for (int64_t j = 0; j < m; j += kLaneWidth) sum += load_lane(row + j) * load_lane(weight + j);
    const float mean = lane_sum(sum);
    for (int64_t j = 0; j < m; j += kLaneWidth) {
      store_lane(row + j, load_lane(weight + j) * (load_lane(row + j) - mean));
    }
  }
  std::fill(grad_key, grad_key + shape.keys, 0.f);
  for (int64_t i = 0; i < shape.queries; ++i) {
    const float* const row = logits + i * m;
    for (int64_t j = 0; j < shape.queries; ++j) grad_position[i * shape.queries + j] += row[j];
    for (int64_t j = 0; j < shape.keys; ++j) grad_key[j] += row[j];
  }
  multiply<kLanes>(m, d, n, weights, 1, m, grad, d, result, d);
  unpack_rows(result, shape.keys, shape.width, d, 1.f, grad_v);
  multiply<kLanes>(m, d, n, logits, 1, m, queries, d, result, d);
  unpack_rows(result, shape.keys, shape.width, d, 1.f, grad_k);
  multiply<kLanes>(n, d, m, logits, m, 1, keys, d, result, d);
  unpack_rows(result, shape.queries, shape.width, d, scale, grad_q);
}

// One instance an instruction set, chosen at the first call.
#define REMOMASK_ATTENTION_INSTANCE(name, lanes, ...)                                              \
  __VA_ARGS__ void forward_##name(const HeadShape& shape, ConstRows q, ConstRows k, ConstRows v,   \
                                  const float* position, const float* key, float* weights,         \
                                  Rows out, float* scratch) {                                      \
    forward_body<lanes>(shape, q, k, v, position, key, weights, out, scratch);                     \
  }                                                                                                \
  __VA_ARGS__ void backward_##name(const HeadShape& shape, ConstRows grad_out, ConstRows q,        \
                                   ConstRows k, ConstRows v, const float* weights, Rows grad_q,    \
                                   Rows grad_k, Rows grad_v, float* grad_position,                 \
                                   float* grad_key, float* scratch) {                              \
    backward_body<lanes>(shape, grad_out, q, k, v, weights, grad_q, grad_k, grad_v, grad_position, \
                         grad_key, scratch);                                                       \
  }

REMOMASK_ATTENTION_INSTANCE(baseline, 1)
#if defined(__x86_64__)
REMOMASK_ATTENTION_INSTANCE(avx2, 1, __attribute__((target("avx2,fma"))))
REMOMASK_ATTENTION_INSTANCE(avx512, 2,
                            __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl"))))
#endif
#undef REMOMASK_ATTENTION_INSTANCE

struct AttentionInstance {
  decltype(&forward_baseline) forward = forward_baseline;
  decltype(&backward_baseline) backward = backward_baseline;
};

const AttentionInstance& attention_instance() {
  static const AttentionInstance instance = [] {
    AttentionInstance chosen;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
      chosen = {forward_avx512, backward_avx512};
    } else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
      chosen = {forward_avx2, backward_avx2};
    }
#endif
    return chosen;
  }();
  return instance;
}

}  // namespace

void attend_head(const HeadShape& shape, ConstRows q, ConstRows k, ConstRows v,
                 const float* position, const float* key, float* weights, Rows out,
                 float* scratch) {
  attention_instance().forward(shape, q, k, v, position, key, weights, out, scratch);
}

void attend_head_backward(const HeadShape& shape, ConstRows grad_out, ConstRows q, ConstRows k,
                          ConstRows v, const float* weights, Rows grad_q, Rows grad_k, Rows grad_v,
                          float* grad_position, float* grad_key, float* scratch) {
  attention_instance().backward(shape, grad_out, q, k, v, weights, grad_q, grad_k, grad_v,
                                grad_position, grad_key, scratch);
}

}  // namespace remomask::generator
