#include "bench/flop_counter.h"

#include <ATen/core/Tensor.h>

#include <atomic>
#include <functional>
#include <map>
#include <string>

namespace remomask {

namespace {

std::atomic<double> counted{0};  // libtorch calls back a plain function

using Inputs = c10::ArrayRef<const c10::IValue>;

double elements(const at::Tensor& x) { return static_cast<double>(x.numel()); }

/// Products [.., m, k] x [.., k, n] of inputs `first` and `first + 1`.
double product_flops(const Inputs& inputs, size_t first) {
  const at::Tensor &a = inputs[first].toTensor(), &b = inputs[first + 1].toTensor();
  return 2 * elements(a) * static_cast<double>(b.size(-1));
}

/// Every one of the `values` of the smaller side of a convolution (its output, or the input of a
/// transposed one) meets the weights [C, ...] of one channel.
double convolution_flops(double values, const at::Tensor& weight) {
  return 2 * values * elements(weight) / static_cast<double>(weight.size(0));
}

/// convolution(input, weight, bias, stride, padding, dilation, transposed, ...)
double convolution_forward_flops(const Inputs& inputs) {
  const at::Tensor &input = inputs[0].toTensor(), &weight = inputs[1].toTensor();
  if (inputs[6].toBool()) return convolution_flops(elements(input), weight);
  const auto stride = inputs[3].toIntVector(), padding = inputs[4].toIntVector(),
             dilation = inputs[5].toIntVector();
  auto out = static_cast<double>(input.size(0) * weight.size(0));
  for (int64_t d = 2; d < input.dim(); ++d) {
    const auto i = static_cast<size_t>(d - 2);
    const int64_t extent = dilation[i] * (weight.size(d) - 1) + 1;
    out *= static_cast<double>((input.size(d) + 2 * padding[i] - extent) / stride[i] + 1);
  }
  return convolution_flops(out, weight);
}

/// convolution_backward(gradient, input, weight, bias, stride, padding, dilation,
/// transposed, ...): the gradients of input and weights cost a convolution each.
double convolution_backward_flops(const Inputs& inputs) {
  const at::Tensor& smaller = inputs[inputs[7].toBool() ? 1 : 0].toTensor();
  return 2 * convolution_flops(elements(smaller), inputs[2].toTensor());
}

/// softmax(Q K^T) V of q [B, n, width], k [B, m, width]: two products; four backward.
double attention_flops(const Inputs& inputs) {
  const at::Tensor &q = inputs[0].toTensor(), &k = inputs[1].toTensor();
  return 4 * elements(q) * static_cast<double>(k.size(1));
}

/// The same of sequences that lie one after the other in x [G, M, 3 width].
double packed_attention_flops(const Inputs& inputs) {
  const at::Tensor& x = inputs[0].toTensor();
  const auto offsets = inputs[1].toIntVector();
  double pairs = 0;
  for (size_t i = 1; i < offsets.size(); ++i) {
    const auto length = static_cast<double>(offsets[i] - offsets[i - 1]);
    pairs += length * length;
  }
  return 4 * pairs * static_cast<double>(x.size(0) * x.size(2)) / 3;
}

const std::map<std::string, std::function<double(const Inputs&)>>& rules() {
  static const std::map<std::string, std::function<double(const Inputs&)>> all = {
      {"aten::mm", [](const Inputs& x) { return product_flops(x, 0); }},
      {"aten::bmm", [](const Inputs& x) { return product_flops(x, 0); }},
      {"aten::addmm", [](const Inputs& x) { return product_flops(x, 1); }},
      {"aten::baddbmm", [](const Inputs& x) { return product_flops(x, 1); }},
      {"aten::convolution", convolution_forward_flops},
      {"aten::convolution_backward", convolution_backward_flops},
      {"remomask::attention", attention_flops},
      {"remomask::attention_backward", [](const Inputs& x) { return 2 * attention_flops(x); }},
      {"remomask::packed_attention", packed_attention_flops},
      {"remomask::packed_attention_backward",
       [](const Inputs& x) { return 2 * packed_attention_flops(x); }},
  };
  return all;
}

std::unique_ptr<at::ObserverContext> count_function(const at::RecordFunction& function) {
  const auto rule = rules().find(function.name());
  if (rule != rules().end()) {
    const double flops = rule->second(function.inputs());
    double before = counted.load();
    while (!counted.compare_exchange_weak(before, before + flops)) {
    }
  }
  return nullptr;
}

}  // namespace

FlopCounter::FlopCounter() {
  counted = 0;
  callback_ = at::addGlobalCallback(at::RecordFunctionCallback(count_function).needsInputs(true));
}

FlopCounter::~FlopCounter() { at::removeCallback(callback_); }

double FlopCounter::count() const { return counted; }

}  // namespace remomask
