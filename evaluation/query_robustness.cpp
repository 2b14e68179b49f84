#include "evaluation/query_robustness.h"

#include <fmt/format.h>
#include <torch/utils.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "remomask/error.h"
#include "text/words.h"

namespace remomask::evaluation {

namespace {

constexpr std::array<double, 5> kPartWeights = {0, 0.1, 0.3, 1, 3};

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  std::string lower = word;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(words.begin(), words.end(), lower) != words.end();
}

bool is_article(const std::string& word) { return is_one_of(word, {"a", "an", "the"}); }

bool is_punctuation(const std::string& word) {
  return word.size() == 1 && std::ispunct(static_cast<unsigned char>(word[0]));
}

std::string joined_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty() && !is_punctuation(word)) text += ' ';
    text += word;
  }
  return text;
}

std::vector<std::string> without_subject(std::vector<std::string> words) {
  const size_t subject = !words.empty() && is_article(words[0]) ? 1 : 0;
  if (subject < words.size() &&
      is_one_of(words[subject], {"person", "man", "woman", "human", "figure", "someone", "somebody",
                                 "he", "she"})) {
    const bool is = subject + 1 < words.size() && is_one_of(words[subject + 1], {"is"});
    words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(subject + 1 + is));
  }
  return words;
}

/// Figures of the rows of `similarity` that are chosen.
class QueryJudge {
 public:
  QueryJudge(const EncodedSplit& split, const std::vector<db::TrainingClip>& clips,
             const BootstrapOptions& bootstrap)
      : correct_(protocol_plan(RetrievalProtocol::duplicates, split.captions, clips).correct),
        caption_clip_(split.captions.clips),
        clips_(clips),
        bootstrap_(bootstrap) {}

  QueryFigures figures(const std::string& name, const at::Tensor& similarity,
                       const at::Tensor& compared, const std::vector<int64_t>& rows) const {
    const at::Tensor chosen = torch::tensor(rows, torch::kLong);
    const at::Tensor scores = similarity.index_select(0, chosen);
    const at::Tensor first = scores.argmax(1);
    double labelled = 0, same = 0;
    for (size_t i = 0; i < rows.size(); ++i) {
      const std::string& wanted = clips_[caption_clip_[static_cast<size_t>(rows[i])]].meaning;
      if (wanted.empty()) continue;
      labelled += 1;
      same += clips_[static_cast<size_t>(first.data_ptr<int64_t>()[i])].meaning == wanted;
    }
    return {name,
            recall_figures(best_ranks(scores, correct_.index_select(0, chosen)), {rows.size()},
                           scores.size(1), bootstrap_),
            labelled > 0 ? 100 * same / labelled : 0, best_overlap(scores, compared)};
  }

 private:
  at::Tensor correct_;
  std::vector<size_t> caption_clip_;
  const std::vector<db::TrainingClip>& clips_;
  BootstrapOptions bootstrap_;
};

nlohmann::json query_json(const std::vector<QueryFigures>& all) {
  nlohmann::json result = nlohmann::json::array();
  for (const QueryFigures& figures : all) {
    nlohmann::json& json = result.emplace_back();
    json = {{"name", figures.name},
            {"queries", figures.recall.queries},
            {"median_rank", figures.recall.median_rank},
            {"same_content_and_style", figures.same_meaning},
            {"overlap", figures.overlap}};
    for (size_t i = 0; i < kRecallRanks.size(); ++i) {
      json["R@" + std::to_string(kRecallRanks[i])] = figures.recall.recall[i];
    }
  }
  return result;
}

}  // namespace

const char* query_form_name(QueryForm form) {
  switch (form) {
    case QueryForm::as_written:
      return "as written";
    case QueryForm::upper_case:
      return "UPPER CASE";
    case QueryForm::exclaimed:
      return "with a final !";
    case QueryForm::no_punctuation:
      return "no punctuation";
    case QueryForm::no_articles:
      return "no articles";
    case QueryForm::no_subject:
      return "no subject";
  }
  throw Error("this is no form of a query");
}

std::string write_query(const std::string& caption, QueryForm form) {
  std::vector<std::string> words = text::split_words(caption);
  switch (form) {
    case QueryForm::as_written:
      return caption;
    case QueryForm::upper_case: {
      std::string text = caption;
      for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      return text;
    }
    case QueryForm::exclaimed:
      while (!words.empty() && is_punctuation(words.back())) words.pop_back();
      words.emplace_back("!");
      break;
    case QueryForm::no_punctuation:
      std::erase_if(words, is_punctuation);
      break;
    case QueryForm::no_articles:
      std::erase_if(words, is_article);
      break;
    case QueryForm::no_subject:
      words = without_subject(words);
      break;
  }
  const bool empty = std::all_of(words.begin(), words.end(), is_punctuation);
  return empty ? caption : joined_words(words);
}

at::Tensor part_similarity(const EncodedSplit& split) {
  return torch::matmul(split.text_parts.flatten(1), split.motion_parts.flatten(1).t()) /
         split.text_parts.size(1);
}

at::Tensor rerank(const at::Tensor& similarity, const at::Tensor& parts, double weight,
                  int64_t depth) {
  const at::Tensor best = std::get<1>(similarity.topk(std::min(depth, similarity.size(1)), 1));
  // Cosines: what is not among the best lies below the least that a sum can be.
  const at::Tensor others = similarity - 2 * (1 + weight);
  return others.scatter(1, best, (similarity + weight * parts).gather(1, best));
}

double best_overlap(const at::Tensor& one, const at::Tensor& two, int64_t depth) {
  const int64_t count = std::min(depth, one.size(1));
  const at::Tensor a = std::get<1>(one.topk(count, 1)), b = std::get<1>(two.topk(count, 1));
  return 100 *
         a.unsqueeze(2).eq(b.unsqueeze(1)).sum({1, 2}).to(torch::kDouble).mean().item<double>() /
         static_cast<double>(count);
}

void to_json(nlohmann::json& json, const QueryRobustness& robustness) {
  json = {{"forms", query_json(robustness.forms)},
          {"paraphrases", query_json(robustness.paraphrases)},
          {"reranked", query_json(robustness.reranked)}};
}

QueryRobustness measure_query_robustness(const retriever::Retriever& retriever,
                                         const std::vector<db::TrainingClip>& clips,
                                         const BootstrapOptions& bootstrap,
                                         const Monitor& monitor) {
  const EncodedSplit split = encode_split(retriever, clips, true, monitor);
  const std::vector<size_t>& caption_clip = split.captions.clips;
  const QueryJudge judge(split, clips, bootstrap);
  const at::Tensor similarity = torch::matmul(split.text, split.motion.t());
  std::vector<int64_t> every, first, others, first_of_others;
  for (size_t t = 0; t < caption_clip.size(); ++t) {
    const auto row = static_cast<int64_t>(t);
    every.push_back(row);
    if (t == 0 || caption_clip[t] != caption_clip[t - 1]) {
      first.push_back(row);
    } else {
      others.push_back(row);
      first_of_others.push_back(first.back());
    }
  }
  QueryRobustness result;
  for (const QueryForm form : kQueryForms) {
    std::vector<std::string> texts;
    for (const std::string& caption : split.captions.texts) {
      texts.push_back(write_query(caption, form));
    }
    const at::Tensor vectors =
        encode_texts(retriever, texts, [&](size_t done) {
          if (monitor.stop_requested()) {
            throw Interrupted("the evaluation of queries was stopped");
          }
          monitor.report({"evaluate queries", static_cast<double>(done),
                          static_cast<double>(texts.size()), query_form_name(form)});
        }).first;
    result.forms.push_back(judge.figures(
        query_form_name(form), torch::matmul(vectors, split.motion.t()), similarity, every));
  }
  const auto rows = [&](const std::vector<int64_t>& numbers) {
    return similarity.index_select(0, torch::tensor(numbers, torch::kLong));
  };
  result.paraphrases.push_back(judge.figures("first captions", similarity, rows(first), first));
  if (!others.empty()) {
    result.paraphrases.push_back(
        judge.figures("other captions", similarity, rows(first_of_others), others));
  }
  const at::Tensor parts = part_similarity(split);
  for (const double weight : kPartWeights) {
    result.reranked.push_back(judge.figures(fmt::format("weight {:g}", weight),
                                            rerank(similarity, parts, weight), similarity, every));
  }
  return result;
}

}  // namespace remomask::evaluation
