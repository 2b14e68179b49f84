#include "generator/biased_attention.h"

#include <ATen/Parallel.h>
#include <ATen/record_function.h>
#include <torch/csrc/autograd/custom_function.h>
#include <torch/types.h>

#include <cmath>
#include <vector>

#include "generator/attention_kernel.h"

namespace remomask::generator {

namespace {

using torch::autograd::AutogradContext;
using torch::autograd::tensor_list;

// The gradient of the position bias is summed over the batch in this many parts
// a head, whatever the number of threads: the same sums in the same order.
constexpr int64_t kBatchParts = 8;

at::Tensor with_dense_rows(const at::Tensor& x) { return x.stride(2) == 1 ? x : x.contiguous(); }

ConstRows head_rows(const at::Tensor& x, int64_t sample, int64_t head, int64_t head_width) {
  return {x.data_ptr<float>() + sample * x.stride(0) + head * head_width, x.stride(1)};
}

Rows writable_rows(const at::Tensor& x, int64_t sample, int64_t head, int64_t head_width) {
  return {x.data_ptr<float>() + sample * x.stride(0) + head * head_width, x.stride(1)};
}

/// libtorch's batched products run one small product after the other, each
/// split over all threads; here every thread takes whole heads.
struct FusedAttention : public torch::autograd::Function<FusedAttention> {
  static at::Tensor forward(AutogradContext* context, const at::Tensor& query,
                            const at::Tensor& keys, const at::Tensor& values,
                            const at::Tensor& position_bias, const at::Tensor& key_bias) {
    const at::Tensor q = with_dense_rows(query), k = with_dense_rows(keys),
                     v = with_dense_rows(values);
    const at::Tensor position = position_bias.contiguous(), key = key_bias.contiguous();
    RECORD_FUNCTION("remomask::attention", std::vector<c10::IValue>({q, k}));
    const int64_t batch = q.size(0), heads = position.size(0);
    const HeadShape shape{q.size(1), k.size(1), q.size(2) / heads};
    const int64_t map = shape.padded_queries() * shape.padded_keys();
    const at::Tensor out = torch::empty({batch, shape.queries, q.size(2)}, q.options());
    const at::Tensor weights = torch::empty({batch * heads, map}, q.options());
    at::parallel_for(0, batch * heads, 1, [&](int64_t begin, int64_t end) {
      std::vector<float> scratch(static_cast<size_t>(shape.scratch()));
      for (int64_t i = begin; i < end; ++i) {
        const int64_t sample = i / heads, head = i % heads;
        attend_head(shape, head_rows(q, sample, head, shape.width),
                    head_rows(k, sample, head, shape.width),
                    head_rows(v, sample, head, shape.width),
                    position.data_ptr<float>() + head * shape.queries * shape.queries,
                    key.data_ptr<float>() + i * shape.keys, weights.data_ptr<float>() + i * map,
                    writable_rows(out, sample, head, shape.width), scratch.data());
      }
    });
    context->save_for_backward({q, k, v, weights});
    context->saved_data["heads"] = heads;
    return out;
  }

  static tensor_list backward(AutogradContext* context, tensor_list gradients) {
    const auto saved = context->get_saved_variables();
    const at::Tensor &q = saved[0], &k = saved[1], &v = saved[2], &weights = saved[3];
    RECORD_FUNCTION("remomask::attention_backward", std::vector<c10::IValue>({q, k}));
    const at::Tensor grad_out = with_dense_rows(gradients[0]);
    const int64_t batch = q.size(0), heads = context->saved_data["heads"].toInt();
    const HeadShape shape{q.size(1), k.size(1), q.size(2) / heads};
    const int64_t map = shape.padded_queries() * shape.padded_keys();
    const at::Tensor grad_q = torch::empty(q.sizes(), q.options()),
                     grad_k = torch::empty(k.sizes(), k.options()),
                     grad_v = torch::empty(v.sizes(), v.options()),
                     grad_key = torch::empty({batch, heads, shape.keys}, q.options());
    const int64_t parts = std::min(batch, kBatchParts);
    const at::Tensor part_sums =
        torch::zeros({parts, heads, shape.queries, shape.queries}, q.options());
    at::parallel_for(0, parts * heads, 1, [&](int64_t begin, int64_t end) {
      std::vector<float> scratch(static_cast<size_t>(shape.scratch()));
      for (int64_t task = begin; task < end; ++task) {
        const int64_t part = task / heads, head = task % heads;
        for (int64_t sample = part * batch / parts; sample < (part + 1) * batch / parts; ++sample) {
          const int64_t i = sample * heads + head;
          attend_head_backward(
              shape, head_rows(grad_out, sample, head, shape.width),
              head_rows(q, sample, head, shape.width), head_rows(k, sample, head, shape.width),
              head_rows(v, sample, head, shape.width), weights.data_ptr<float>() + i * map,
              writable_rows(grad_q, sample, head, shape.width),
              writable_rows(grad_k, sample, head, shape.width),
              writable_rows(grad_v, sample, head, shape.width),
              part_sums.data_ptr<float>() + task * shape.queries * shape.queries,
              grad_key.data_ptr<float>() + i * shape.keys, scratch.data());
        }
      }
    });
    return {grad_q, grad_k, grad_v, part_sums.sum(0), grad_key};
  }
};

/// The same in libtorch's operations, for other types and devices.
at::Tensor composed_attention(const at::Tensor& q, const at::Tensor& k, const at::Tensor& v,
                              const at::Tensor& position, const at::Tensor& key) {
  const int64_t batch = q.size(0), count = q.size(1), width = q.size(2), keys = k.size(1);
  const int64_t heads = position.size(0), head_width = width / heads;
  const auto split = [&](const at::Tensor& x) {
    return x.reshape({batch, x.size(1), heads, head_width}).transpose(1, 2);
  };
  const auto logits = torch::matmul(split(q) * (1.0 / std::sqrt(static_cast<double>(head_width))),
                                    split(k).transpose(2, 3));
  const auto bias = torch::constant_pad_nd(position, {0, keys - count});
  const auto weights = torch::softmax(logits + bias + key.unsqueeze(2), -1);
  return torch::matmul(weights, split(v)).transpose(1, 2).reshape({batch, count, width});
}

}  // namespace

at::Tensor biased_attention(const at::Tensor& q, const at::Tensor& k, const at::Tensor& v,
                            const at::Tensor& position, const at::Tensor& key) {
  if (q.device().is_cpu() && q.scalar_type() == torch::kFloat) {
    return FusedAttention::apply(q, k, v, position, key);
  }
  return composed_attention(q, k, v, position, key);
}

}  // namespace remomask::generator
