#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/retrieval_metrics.h"

namespace remomask::evaluation {

/// Ways to write a caption that do not change what is meant.
enum class QueryForm { as_written, upper_case, exclaimed, no_punctuation, no_articles, no_subject };

inline constexpr QueryForm kQueryForms[] = {QueryForm::as_written,  QueryForm::upper_case,
                                            QueryForm::exclaimed,   QueryForm::no_punctuation,
                                            QueryForm::no_articles, QueryForm::no_subject};

const char* query_form_name(QueryForm form);

/// The caption in that form: ASCII letters in upper case; with a final "!";
/// without ASCII punctuation; without "a", "an", "the"; without a first "a
/// person", "someone" and the like. Where nothing would be left, as it is.
std::string write_query(const std::string& caption, QueryForm form);

/// Mean cosine of the six part vectors, [T, N].
at::Tensor part_similarity(const EncodedSplit& split);

/// The `depth` most similar entries of each row by similarity + weight x parts,
/// the others behind them in their order. All [T, N].
at::Tensor rerank(const at::Tensor& similarity, const at::Tensor& parts, double weight,
                  int64_t depth = 100);

/// Percent of the `depth` best entries of a row that two similarities share, mean
/// over the rows.
double best_overlap(const at::Tensor& one, const at::Tensor& two, int64_t depth = 10);

/// Text-to-motion figures of some queries, protocol `duplicates`.
struct QueryFigures {
  std::string name;
  RecallFigures recall;
  double same_meaning = 0;  ///< percent of the labelled queries whose first hit has their labels
  double overlap = 0;       ///< best_overlap with the queries that they are compared with
};

struct QueryRobustness {
  std::vector<QueryFigures> forms;        ///< all captions, compared with those as written
  std::vector<QueryFigures> paraphrases;  ///< first captions; the others, compared with the first
  std::vector<QueryFigures> reranked;     ///< all captions, by weight of the part vectors
};

void to_json(nlohmann::json& json, const QueryRobustness& robustness);

/// Over the whole split as gallery.
QueryRobustness measure_query_robustness(const retriever::Retriever& retriever,
                                         const std::vector<db::TrainingClip>& clips,
                                         const BootstrapOptions& bootstrap = {},
                                         const Monitor& monitor = {});

}  // namespace remomask::evaluation
