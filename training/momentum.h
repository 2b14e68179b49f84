#pragma once

#include <torch/nn/module.h>

#include <memory>
#include <vector>

#include "retriever/retriever_model.h"
#include "training/bmm_loss.h"

namespace remomask::training {

/// A ring of the last keys with what identifies them. Buffers, so that a
/// checkpoint holds it. Entries that were never written do not count.
class KeyQueue final : public torch::nn::Module {
 public:
  KeyQueue(int64_t size, int64_t width);

  /// Overwrites the oldest entries; more keys than entries keep the last ones.
  void push(const at::Tensor& keys, const PairIdentity& identity);
  int64_t filled() const;
  at::Tensor keys() const;        ///< [filled, E]
  PairIdentity identity() const;  ///< [filled] each

 private:
  int64_t size_;
  at::Tensor keys_, group_, caption_, meaning_, pushed_;
};

/// twin <- momentum x twin + (1 - momentum) x online, for every parameter;
/// buffers are copied. Both modules of one architecture.
void update_twin(torch::nn::Module& twin, torch::nn::Module& online, double momentum);

struct PairBatch {
  encoders::TokenBatch tokens;
  at::Tensor text_states;  ///< [B, S, W] RetrieverModel::frozen_states() of the tokens
  retriever::PatchBatch online_patches;  ///< may lack patches (augmentation)
  retriever::PatchBatch key_patches;
  PairIdentity identity;
};

struct BmmLosses {
  at::Tensor total;
  double motion_to_text, text_to_motion, parts;
};

/// Everything that is trained: the online model, its momentum twin, which
/// makes the keys without dropout and without gradient, two queues, and the
/// temperature.
class BmmModel final : public torch::nn::Module {
 public:
  /// `tower`: the sentence encoder that online model and twin share.
  BmmModel(const retriever::RetrieverConfig& config, std::shared_ptr<encoders::TextTower> tower,
           retriever::Queues queues, int64_t queue_size, double momentum, double temperature,
           double same_meaning_weight);

  /// Loss of a batch, ( CE(q^m, [k^t | text queue]) + CE(q^t, [k^m | motion
  /// queue]) ) / 2 + part_weight x the same for the parts (HBM, batch keys
  /// only). `token_drop`: share of words hidden from the online model.
  /// Keeps the keys for after_step().
  BmmLosses loss(const PairBatch& batch, double part_weight, double token_drop);
  /// Moves the twin, then pushes the kept keys into the queues.
  void after_step();
  /// Text and motion keys of a batch [B, E].
  std::pair<at::Tensor, at::Tensor> keys(const PairBatch& batch);

  /// 1 / temperature, at most 100.
  at::Tensor scale() const;
  retriever::RetrieverModel& online() { return *online_; }
  retriever::RetrieverModel& twin() { return *twin_; }
  KeyQueue& text_queue() { return *text_queue_; }
  KeyQueue& motion_queue() { return *motion_queue_; }

 private:
  struct Keys {
    at::Tensor text, motion, text_parts, motion_parts;
    PairIdentity identity;
  };
  Keys make_keys(const PairBatch& batch);
  at::Tensor part_loss(const at::Tensor& motion, const at::Tensor& text, const Keys& keys,
                       const at::Tensor& bias) const;

  retriever::Queues queues_;
  double momentum_, same_meaning_weight_;
  std::shared_ptr<retriever::RetrieverModel> online_, twin_;
  std::shared_ptr<KeyQueue> text_queue_, motion_queue_;
  at::Tensor log_scale_;
  Keys kept_;
};

}  // namespace remomask::training
