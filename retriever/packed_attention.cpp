#include "retriever/packed_attention.h"

#include <ATen/Parallel.h>
#include <ATen/record_function.h>
#include <torch/csrc/autograd/custom_function.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "remomask/error.h"

// The generic BLAS, column-major; row-major matrices are passed as transposes.
extern "C" void sgemm_(const char* trans_a, const char* trans_b, const int* m, const int* n,
                       const int* k, const float* alpha, const float* a, const int* lda,
                       const float* b, const int* ldb, const float* beta, float* c, const int* ldc);

namespace remomask::retriever {

namespace {

/// A row-major matrix inside a larger one.
struct MatrixView {
  float* values;
  int stride;
};

struct ConstMatrixView {
  const float* values;
  int stride;
};

/// c [rows, columns] = scale a b, a [rows, depth] and b [depth, columns], each
/// stored transposed where the flag says so.
void multiply(int rows, int columns, int depth, float scale, ConstMatrixView a, bool a_transposed,
              ConstMatrixView b, bool b_transposed, MatrixView c) {
  const float zero = 0;
  sgemm_(b_transposed ? "T" : "N", a_transposed ? "T" : "N", &columns, &rows, &depth, &scale,
         b.values, &b.stride, a.values, &a.stride, &zero, c.values, &c.stride);
}

struct PackedShape {
  int64_t groups, rows, width, heads;
  std::vector<int64_t> offsets, probability_offsets;  ///< [B + 1] each

  int64_t sequences() const { return static_cast<int64_t>(offsets.size()) - 1; }
  int64_t probabilities() const { return groups * heads * probability_offsets.back(); }
  int head_width() const { return static_cast<int>(width / heads); }
  int length(int64_t b) const { return static_cast<int>(offsets[b + 1] - offsets[b]); }
  /// First element of (group, sequence, head) in a [G, M, columns] tensor.
  int64_t place(int64_t g, int64_t b, int64_t h, int64_t columns) const {
    return (g * rows + offsets[b]) * columns + h * head_width();
  }
  int64_t probability_place(int64_t g, int64_t b, int64_t h) const {
    return (g * probability_offsets.back() + probability_offsets[b]) * heads +
           h * length(b) * length(b);
  }

  template <typename Function>
  void for_each_head(const Function& function) const {
    at::parallel_for(0, groups * sequences(), 4, [&](int64_t first, int64_t last) {
      for (int64_t i = first; i < last; ++i) {
        for (int64_t h = 0; h < heads; ++h) function(i / sequences(), i % sequences(), h);
      }
    });
  }
};

PackedShape packed_shape(const at::Tensor& x, const std::vector<int64_t>& offsets, int64_t heads) {
  PackedShape shape{x.size(0), x.size(1), x.size(2) / 3, heads, offsets, {0}};
  for (int64_t b = 0; b < shape.sequences(); ++b) {
    const int64_t n = shape.length(b);
    shape.probability_offsets.push_back(shape.probability_offsets.back() + n * n);
  }
  return shape;
}

void softmax_row(float* row, int count) {
  const float highest = *std::max_element(row, row + count);
  float sum = 0;
  for (int i = 0; i < count; ++i) {
    row[i] = std::exp(row[i] - highest);
    sum += row[i];
  }
  const float factor = 1 / sum;
  for (int i = 0; i < count; ++i) row[i] *= factor;
}

at::Tensor attend(const PackedShape& shape, const at::Tensor& x, const at::Tensor& probabilities) {
  const at::Tensor result = at::empty({shape.groups, shape.rows, shape.width}, x.options());
  const float* input = x.data_ptr<float>();
  float *weights = probabilities.data_ptr<float>(), *output = result.data_ptr<float>();
  const int width = static_cast<int>(shape.width), depth = shape.head_width();
  const float scale = 1 / std::sqrt(static_cast<float>(depth));
  shape.for_each_head([&](int64_t g, int64_t b, int64_t h) {
    const int n = shape.length(b);
    const float* query = input + shape.place(g, b, h, 3 * width);
    float* p = weights + shape.probability_place(g, b, h);
    multiply(n, n, depth, scale, {query, 3 * width}, false, {query + width, 3 * width}, true,
             {p, n});
    for (int i = 0; i < n; ++i) softmax_row(p + static_cast<ptrdiff_t>(i) * n, n);
    multiply(n, depth, n, 1, {p, n}, false, {query + 2 * width, 3 * width}, false,
             {output + shape.place(g, b, h, width), width});
  });
  return result;
}

at::Tensor attention_gradient(const PackedShape& shape, const at::Tensor& x,
                              const at::Tensor& probabilities, const at::Tensor& gradient) {
  const at::Tensor result = at::empty_like(x);
  const float *input = x.data_ptr<float>(), *upper = gradient.data_ptr<float>();
  const float* weights = probabilities.data_ptr<float>();
  float* output = result.data_ptr<float>();
  const int width = static_cast<int>(shape.width), depth = shape.head_width();
  const float scale = 1 / std::sqrt(static_cast<float>(depth));
  shape.for_each_head([&](int64_t g, int64_t b, int64_t h) {
    const int n = shape.length(b);
    const int64_t place = shape.place(g, b, h, 3 * width);
    const float* query = input + place;
    float* query_gradient = output + place;
    const ConstMatrixView up{upper + shape.place(g, b, h, width), width};
    const float* p = weights + shape.probability_place(g, b, h);
    thread_local std::vector<float> logits;
    logits.resize(static_cast<size_t>(n) * n);
    // dV = P^T dO, dP = dO V^T, dS = P (dP - sum(dP P)), dQ = dS K, dK = dS^T Q.
    multiply(n, depth, n, 1, {p, n}, true, up, false, {query_gradient + 2 * width, 3 * width});
    multiply(n, n, depth, 1, up, false, {query + 2 * width, 3 * width}, true, {logits.data(), n});
    for (int i = 0; i < n; ++i) {
      float* row = logits.data() + static_cast<ptrdiff_t>(i) * n;
      const float* probability = p + static_cast<ptrdiff_t>(i) * n;
      float sum = 0;
      for (int k = 0; k < n; ++k) sum += row[k] * probability[k];
      for (int k = 0; k < n; ++k) row[k] = probability[k] * (row[k] - sum);
    }
    multiply(n, depth, n, scale, {logits.data(), n}, false, {query + width, 3 * width}, false,
             {query_gradient, 3 * width});
    multiply(n, depth, n, scale, {logits.data(), n}, true, {query, 3 * width}, false,
             {query_gradient + width, 3 * width});
  });
  return result;
}

class PackedAttentionFunction : public torch::autograd::Function<PackedAttentionFunction> {
 public:
  static at::Tensor forward(torch::autograd::AutogradContext* context, const at::Tensor& input,
                            const std::vector<int64_t>& offsets, int64_t heads) {
    const at::Tensor x = input.contiguous();
    RECORD_FUNCTION("remomask::packed_attention", std::vector<c10::IValue>({x, offsets}));
    const PackedShape shape = packed_shape(x, offsets, heads);
    const at::Tensor probabilities = at::empty({shape.probabilities()}, x.options());
    const at::Tensor result = attend(shape, x, probabilities);
    context->save_for_backward({x, probabilities});
    context->saved_data["offsets"] = offsets;
    context->saved_data["heads"] = heads;
    return result;
  }

  static torch::autograd::tensor_list backward(torch::autograd::AutogradContext* context,
                                               const torch::autograd::tensor_list& gradients) {
    const auto saved = context->get_saved_variables();
    RECORD_FUNCTION("remomask::packed_attention_backward",
                    std::vector<c10::IValue>({saved[0], context->saved_data["offsets"]}));
    const PackedShape shape = packed_shape(saved[0], context->saved_data["offsets"].toIntVector(),
                                           context->saved_data["heads"].toInt());
    return {attention_gradient(shape, saved[0], saved[1], gradients[0].contiguous()), at::Tensor(),
            at::Tensor()};
  }
};

}  // namespace

at::Tensor packed_attention(const at::Tensor& query_key_value, const std::vector<int64_t>& offsets,
                            int64_t heads) {
  if (!query_key_value.device().is_cpu()) {
    throw Error("the retriever's motion encoder runs on the CPU; choose device cpu");
  }
  return PackedAttentionFunction::apply(query_key_value, offsets, heads);
}

}  // namespace remomask::retriever
