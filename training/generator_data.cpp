#include "training/generator_data.h"

#include <torch/types.h>

#include <algorithm>
#include <map>
#include <string>

#include "base/random.h"
#include "remomask/error.h"

namespace remomask::training {

namespace {

constexpr int kMinFrames = 8;
constexpr size_t kTextBlock = 256;
constexpr int kSecondOffset = 2;

bool is_usable(const db::TrainingClip& clip) {
  return !clip.captions.empty() && clip.features.frames >= kMinFrames;
}

motion::Features rows_from(const motion::Features& features, int first) {
  motion::Features part(features.frames - first, features.dim);
  std::copy(features.row(first), features.row(0) + features.values.size(), part.values.begin());
  return part;
}

/// Numbers the distinct captions of all clips in the order of their appearance.
struct CaptionNumbers {
  std::map<std::string, int64_t> numbers;
  std::vector<std::string> captions;

  int64_t number(const std::string& caption) {
    const auto [place, is_new] = numbers.emplace(caption, static_cast<int64_t>(captions.size()));
    if (is_new) captions.push_back(caption);
    return place->second;
  }
};

/// Numbers the meanings of clips; a clip without one gets a number of its own.
struct MeaningNumbers {
  std::map<std::string, int> numbers;
  int next = 0;

  int number(const std::string& meaning) {
    if (meaning.empty()) return next++;
    const auto [place, is_new] = numbers.emplace(meaning, next);
    if (is_new) ++next;
    return place->second;
  }
};

CaptionFeatures encode_captions(const std::vector<std::string>& captions,
                                const retriever::Retriever& retriever, const Monitor& monitor) {
  CaptionFeatures features;
  features.offsets.push_back(0);
  std::vector<at::Tensor> states, queries;
  for (size_t first = 0; first < captions.size(); first += kTextBlock) {
    if (monitor.stop_requested()) throw Interrupted("encoding captions stopped");
    const size_t last = std::min(captions.size(), first + kTextBlock);
    const retriever::TextEncoding encoding =
        retriever.encode_text({captions.begin() + static_cast<std::ptrdiff_t>(first),
                               captions.begin() + static_cast<std::ptrdiff_t>(last)});
    states.push_back(encoding.states.flatten(0, 1).index_select(
        0, torch::nonzero(encoding.mask.reshape({-1})).squeeze(1)));
    queries.push_back(encoding.query);
    const auto lengths = encoding.mask.sum(1).contiguous();
    for (int64_t i = 0; i < lengths.size(0); ++i) {
      features.offsets.push_back(features.offsets.back() + lengths.data_ptr<int64_t>()[i]);
    }
    monitor.report(
        {"encode captions", static_cast<double>(last), static_cast<double>(captions.size()), ""});
  }
  features.states = torch::cat(states, 0);
  features.query = torch::cat(queries, 0);
  return features;
}

TokenSplit tokenize_split(const std::vector<const db::TrainingClip*>& clips, bool second_offset,
                          const tokenizer::Tokenizer& tokenizer, CaptionNumbers& captions,
                          MeaningNumbers& meanings) {
  TokenSplit split;
  std::vector<const motion::Features*> whole;
  std::vector<motion::Features> shifted;
  for (const auto* clip : clips) {
    whole.push_back(&clip->features);
    if (second_offset) shifted.push_back(rows_from(clip->features, kSecondOffset));
  }
  const auto tokens = tokenizer.encode(whole);
  std::vector<const motion::Features*> parts;
  for (const auto& part : shifted) parts.push_back(&part);
  const auto shifted_tokens = second_offset ? tokenizer.encode(parts) : tokens;
  int64_t query = 0;
  for (size_t i = 0; i < clips.size(); ++i) {
    TokenClip clip;
    clip.tokens.push_back(tokens[i]);
    if (second_offset) clip.tokens.push_back(shifted_tokens[i]);
    for (const auto& caption : clips[i]->captions)
      clip.captions.push_back(captions.number(caption));
    clip.group = clips[i]->group;
    clip.meaning = meanings.number(clips[i]->meaning);
    clip.first_query = query;
    query += static_cast<int64_t>(clip.captions.size());
    split.clips.push_back(std::move(clip));
  }
  return split;
}

at::Tensor encode_motions(const std::vector<const db::TrainingClip*>& clips,
                          const retriever::Retriever& retriever) {
  std::vector<const motion::Features*> features;
  for (const auto* clip : clips) features.push_back(&clip->features);
  return retriever.encode_motion(features).global;
}

RetrievalTable split_table(const TokenSplit& split, const at::Tensor& own_motion,
                           const GeneratorData& data, bool with_own_meaning) {
  std::vector<int64_t> captions, clips;
  RetrievalQueries queries;
  for (size_t i = 0; i < split.clips.size(); ++i) {
    for (const int64_t caption : split.clips[i].captions) {
      captions.push_back(caption);
      clips.push_back(static_cast<int64_t>(i));
      queries.kinds.groups.push_back(split.clips[i].group);
      if (!with_own_meaning) queries.kinds.meanings.push_back(split.clips[i].meaning);
    }
  }
  queries.text = data.captions.query.index_select(0, torch::tensor(captions, torch::kLong));
  queries.own_motion = own_motion.index_select(0, torch::tensor(clips, torch::kLong));
  MotionKinds kinds;
  for (const auto& clip : data.train.clips) {
    kinds.groups.push_back(clip.group);
    if (!with_own_meaning) kinds.meanings.push_back(clip.meaning);
  }
  return build_retrieval_table(queries, data.motion, kinds);
}

/// Base tokens of the best hits, padded to the longest.
at::Tensor make_hit_tokens(const GeneratorData& data, const std::vector<ConditionSample>& samples,
                           int64_t sequence_hits) {
  const auto used = [&](const ConditionSample& sample) {
    return std::min<size_t>(sample.hits.size(), static_cast<size_t>(sequence_hits));
  };
  const auto map_of = [&](const DrawnHit& hit) {
    return data.train.clips[static_cast<size_t>(hit.motion)].tokens[0].select(2, 0);
  };
  int64_t longest = 0;
  for (const auto& sample : samples) {
    for (size_t i = 0; i < used(sample); ++i) {
      longest = std::max(longest, map_of(sample.hits[i]).size(0));
    }
  }
  const auto tokens = torch::full(
      {static_cast<int64_t>(samples.size()), sequence_hits, longest, data.rows}, -1, torch::kLong);
  for (size_t b = 0; b < samples.size(); ++b) {
    for (size_t i = 0; i < used(samples[b]); ++i) {
      const auto map = map_of(samples[b].hits[i]);
      tokens[static_cast<int64_t>(b)][static_cast<int64_t>(i)].slice(0, 0, map.size(0)).copy_(map);
    }
  }
  return tokens;
}

}  // namespace

GeneratorData prepare_generator_data(const std::vector<db::TrainingClip>& train,
                                     const std::vector<db::TrainingClip>& val,
                                     const tokenizer::Tokenizer& tokenizer,
                                     const retriever::Retriever& retriever,
                                     const Monitor& monitor) {
  const torch::NoGradGuard no_grad;
  const auto usable = [](const std::vector<db::TrainingClip>& clips) {
    std::vector<const db::TrainingClip*> result;
    for (const auto& clip : clips) {
      if (is_usable(clip)) result.push_back(&clip);
    }
    return result;
  };
  const auto train_clips = usable(train), val_clips = usable(val);
  if (train_clips.empty()) {
    throw Error("training the generator: no training clip has a caption and at least " +
                std::to_string(kMinFrames) + " frames; import motions with texts first");
  }
  GeneratorData data;
  data.rows = tokenizer.config().rows;
  data.levels = tokenizer.config().levels;
  data.codes = tokenizer.config().codes;
  CaptionNumbers captions;
  MeaningNumbers meanings;
  monitor.report({"encode motions", 0, 2, "tokens"});
  data.train = tokenize_split(train_clips, true, tokenizer, captions, meanings);
  data.val = tokenize_split(val_clips, false, tokenizer, captions, meanings);
  for (size_t i = 0; i < train_clips.size(); ++i) {
    data.train.clips[i].source = static_cast<size_t>(train_clips[i] - train.data());
  }
  data.captions = encode_captions(captions.captions, retriever, monitor);
  monitor.report({"encode motions", 1, 2, "vectors"});
  data.motion = encode_motions(train_clips, retriever);
  std::vector<at::Tensor> texts;
  for (const auto& clip : data.train.clips) {
    const auto mean =
        data.captions.query.index_select(0, torch::tensor(clip.captions, torch::kLong)).mean(0);
    texts.push_back(mean / mean.norm().clamp_min(1e-9));
  }
  data.motion_text = torch::stack(texts);
  const auto find_hits = [&](TokenSplit& split, const at::Tensor& own_motion) {
    split.hits = split_table(split, own_motion, data, true);
    split.unfamiliar_hits = split_table(split, own_motion, data, false);
  };
  find_hits(data.train, data.motion);
  if (!val_clips.empty()) find_hits(data.val, encode_motions(val_clips, retriever));
  monitor.report({"encode motions", 2, 2, ""});
  return data;
}

generator::Condition make_condition(const GeneratorData& data,
                                    const std::vector<ConditionSample>& samples, int64_t max_hits,
                                    int64_t sequence_hits) {
  const auto batch = static_cast<int64_t>(samples.size());
  const CaptionFeatures& captions = data.captions;
  int64_t longest = 1;
  std::vector<int64_t> chosen;
  for (const auto& sample : samples) {
    chosen.push_back(sample.caption);
    longest =
        std::max(longest, captions.offsets[sample.caption + 1] - captions.offsets[sample.caption]);
  }
  generator::Condition condition;
  condition.text_states = torch::zeros({batch, longest, captions.states.size(1)});
  condition.text_mask = torch::zeros({batch, longest}, torch::kBool);
  condition.text_query = captions.query.index_select(0, torch::tensor(chosen, torch::kLong));
  condition.hit_motion = torch::zeros({batch, max_hits, data.motion.size(1)});
  condition.hit_text = torch::zeros_like(condition.hit_motion);
  condition.hit_similarity = torch::zeros({batch, max_hits});
  condition.hit_mask = torch::zeros({batch, max_hits}, torch::kBool);
  condition.hit_tokens = make_hit_tokens(data, samples, sequence_hits);
  condition.use_text = torch::zeros({batch}, torch::kBool);
  condition.use_retrieval = torch::zeros({batch}, torch::kBool);
  for (int64_t b = 0; b < batch; ++b) {
    const ConditionSample& sample = samples[static_cast<size_t>(b)];
    const int64_t first = captions.offsets[sample.caption];
    const int64_t length = captions.offsets[sample.caption + 1] - first;
    condition.text_states[b]
        .slice(0, 0, length)
        .copy_(captions.states.slice(0, first, first + length));
    condition.text_mask[b].slice(0, 0, length).fill_(true);
    for (size_t i = 0; i < sample.hits.size() && static_cast<int64_t>(i) < max_hits; ++i) {
      const auto place = static_cast<int64_t>(i);
      condition.hit_motion[b][place].copy_(data.motion[sample.hits[i].motion]);
      condition.hit_text[b][place].copy_(data.motion_text[sample.hits[i].motion]);
      condition.hit_similarity.data_ptr<float>()[b * max_hits + place] = sample.hits[i].similarity;
      condition.hit_mask.data_ptr<bool>()[b * max_hits + place] = true;
    }
    condition.use_text.data_ptr<bool>()[b] = sample.use_text;
    condition.use_retrieval.data_ptr<bool>()[b] = sample.use_retrieval;
  }
  return condition;
}

std::vector<std::vector<size_t>> length_buckets(const std::vector<TokenClip>& clips, int64_t batch,
                                                uint64_t seed, uint64_t epoch) {
  CounterRandom random(mix_seed(seed, 0x6275636bu), epoch);
  std::vector<size_t> order = random.permutation(clips.size());
  const auto size = static_cast<size_t>(batch);
  const auto length = [&](size_t clip) { return clips[clip].tokens[0].size(0); };
  std::vector<std::vector<size_t>> batches;
  for (size_t first = 0; first < order.size(); first += 8 * size) {
    const size_t last = std::min(order.size(), first + 8 * size);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](size_t a, size_t b) { return length(a) < length(b); });
    for (size_t i = first; i < last; i += size) {
      batches.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(i),
                           order.begin() + static_cast<std::ptrdiff_t>(std::min(last, i + size)));
    }
  }
  std::vector<std::vector<size_t>> shuffled;
  for (const size_t i : random.permutation(batches.size())) shuffled.push_back(batches[i]);
  return shuffled;
}

PaddedTokens pad_tokens(const std::vector<at::Tensor>& maps) {
  int64_t longest = 0;
  bool equal = true;
  for (const auto& map : maps) {
    longest = std::max(longest, map.size(0));
    equal = equal && map.size(0) == maps[0].size(0);
  }
  if (equal) return {torch::stack(maps), {}};
  const auto batch = static_cast<int64_t>(maps.size());
  PaddedTokens padded{
      torch::zeros({batch, longest, maps[0].size(1), maps[0].size(2)}, torch::kLong),
      torch::zeros({batch, longest}, torch::kBool)};
  for (int64_t b = 0; b < batch; ++b) {
    const auto& map = maps[static_cast<size_t>(b)];
    padded.tokens[b].slice(0, 0, map.size(0)).copy_(map);
    padded.frame_mask[b].slice(0, 0, map.size(0)).fill_(true);
  }
  return padded;
}

}  // namespace remomask::training
