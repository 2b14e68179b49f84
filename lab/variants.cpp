#include "lab/variants.h"

#include <fmt/format.h>

#include <charconv>
#include <functional>
#include <optional>

#include "remomask/error.h"

namespace remomask::lab {

namespace {

struct KnownVariant {
  ModelVariant variant;
  std::function<void(training::TrainingRecipe&)> apply;
};

constexpr const char *kLevelsPrefix = "levels-", *kDropoutPrefix = "quantizer-dropout-";

void make_momask(training::TrainingRecipe& recipe) {
  training::use_one_row(recipe.model);
  training::ModelConfig& model = recipe.model;
  const std::string preset = preset_name({parse_preset(recipe.preset).size, /*one_row=*/true});
  model.tokenizer.preset = model.masked.preset = model.residual.preset = preset;
}

const std::vector<KnownVariant>& known_variants() {
  static const std::vector<KnownVariant> variants = {
      {{"full", "everything"}, [](training::TrainingRecipe&) {}},
      {{"momask", "one row for the whole body, ordinary attention, no retrieval (MoMask)"},
       make_momask},
      {{"no-retrieval", "rows for body parts, no retrieved motions"},
       [](training::TrainingRecipe& recipe) {
         recipe.model.masked.max_hits = recipe.model.masked.sequence_hits = 0;
       }},
      {{"no-hit-sequences", "retrieved motions as vectors only, not as token maps"},
       [](training::TrainingRecipe& recipe) { recipe.model.masked.sequence_hits = 0; }},
      {{"no-queues", "retriever trained with the negatives of its batch alone"},
       [](training::TrainingRecipe& recipe) {
         recipe.retriever_training.queues = retriever::Queues::none;
       }},
      {{"no-ssta", "text and hits stand before the tokens in ordinary attention"},
       [](training::TrainingRecipe& recipe) { recipe.model.masked.attention = "joined"; }},
      {{"no-rag-cfg", "conditions never dropped in training, no guidance at sampling"},
       [](training::TrainingRecipe& recipe) {
         recipe.model.masked.drops_conditions = false;
         recipe.sampling.guidance = 1;
       }},
      {{"no-part-encoders", "one motion encoder over the whole body in the retriever"},
       [](training::TrainingRecipe& recipe) {
         retriever::use_whole_body_encoder(recipe.model.retriever);
       }},
  };
  return variants;
}

/// The number after `prefix` if the name consists of both and nothing else.
std::optional<int> number_behind(const std::string& name, const std::string& prefix, int least,
                                 int most) {
  if (!name.starts_with(prefix)) return std::nullopt;
  int number = 0;
  const char *first = name.data() + prefix.size(), *last = name.data() + name.size();
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last || number < least || number > most) return std::nullopt;
  return number;
}

KnownVariant find_known(const std::string& name) {
  for (const KnownVariant& known : known_variants()) {
    if (known.variant.name == name) return known;
  }
  if (const auto levels = number_behind(name, kLevelsPrefix, 1, 8)) {
    return {{name, fmt::format("{} level{} of codes", *levels, *levels == 1 ? "" : "s")},
            [levels](training::TrainingRecipe& recipe) {
              recipe.model.tokenizer.levels = recipe.model.residual.levels = *levels;
            }};
  }
  if (const auto percent = number_behind(name, kDropoutPrefix, 0, 90)) {
    return {{name, fmt::format("quantiser dropout {} %", *percent)}, [percent](auto& recipe) {
              recipe.tokenizer_training.codebooks.level_dropout = *percent / 100.0;
            }};
  }
  std::string names;
  for (const KnownVariant& known : known_variants()) names += known.variant.name + ", ";
  throw Error("there is no variant \"" + name + "\"; use " + names +
              "levels-N or quantizer-dropout-PERCENT");
}

}  // namespace

const std::vector<ModelVariant>& model_variants() {
  static const std::vector<ModelVariant> variants = [] {
    std::vector<ModelVariant> list;
    for (const KnownVariant& known : known_variants()) list.push_back(known.variant);
    return list;
  }();
  return variants;
}

ModelVariant find_variant(const std::string& name) { return find_known(name).variant; }

void apply_variant(training::TrainingRecipe& recipe, const std::string& name) {
  const KnownVariant known = find_known(name);
  if (name != "full" && recipe.model.tokenizer.rows == 1) {
    throw Error("preset " + recipe.preset + " is a baseline of its own and has no variants");
  }
  known.apply(recipe);
  recipe.variant = name;
}

}  // namespace remomask::lab
