#include "evaluation/generation_report.h"

#include <torch/utils.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "db/training_set.h"
#include "evaluation/label_prompts.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr uint64_t kPickStream = 0x70696b;

/// Motions of one set, repeat by repeat, each in the order of the prompts.
using MotionTable = std::vector<std::vector<const JudgedMotion*>>;

at::Tensor embedding_rows(const std::vector<const JudgedMotion*>& motions, int64_t width) {
  at::Tensor rows = torch::full({static_cast<int64_t>(motions.size()), width},
                                std::numeric_limits<float>::quiet_NaN());
  for (size_t i = 0; i < motions.size(); ++i) {
    if (motions[i]->embedding.empty()) continue;
    rows[static_cast<int64_t>(i)].copy_(torch::tensor(motions[i]->embedding));
  }
  return rows;
}

/// What the report needs to know of the prompts besides their texts.
struct PromptFacts {
  std::map<int64_t, db::TrainingClip> clips;  ///< only what batch_keys() reads
  std::map<std::string, int> training_clips;  ///< content -> clips of the split train
};

PromptFacts prompt_facts(const db::Database& database) {
  PromptFacts facts;
  for (const db::Clip& clip : database.clips()) {
    db::TrainingClip known;
    known.content = db::clip_content(clip);
    if (clip.labels.contains("content")) {
      known.meaning = known.content + '/' + clip.labels.value("style", "");
    }
    known.group = static_cast<int>(clip.id);
    facts.clips.emplace(clip.id, known);
    if (clip.split == "train") ++facts.training_clips[known.content];
  }
  return facts;
}

class ReportBuilder {
 public:
  ReportBuilder(const GenerationRun& run, const db::Database& database, const JudgeGallery& gallery,
                const Evaluator& evaluator, const GenerationReportOptions& options)
      : run_(run), gallery_(gallery), options_(options), facts_(prompt_facts(database)) {
    std::vector<std::string> texts;
    for (const LabelPrompt& prompt : run.prompts) {
      texts.push_back(prompt.text);
      real_.push_back(gallery.judge(prompt, database.motion(prompt.clip_id), evaluator,
                                    /*exclude_own_group=*/true));
    }
    text_ = evaluator.embed_text(texts);
    real_table_.emplace_back();
    for (const JudgedMotion& motion : real_) real_table_.front().push_back(&motion);
    for (size_t i = 0; i < run.jobs.size(); ++i) {
      if (run.jobs[i].modality) continue;
      generated_.resize(static_cast<size_t>(run.jobs[i].repeat) + 1);
      generated_.back().push_back(&run.outcomes[i].motion);
    }
  }

  GenerationReport report() const {
    GenerationReport result;
    result.protocol = run_.protocol;
    result.protocol["draws"] = options_.draws;
    result.protocol["batch"] = options_.batch;
    const auto add = [&](const char* name, const std::function<bool(const LabelPrompt&)>& member) {
      std::vector<bool> members;
      for (const LabelPrompt& prompt : run_.prompts) members.push_back(member(prompt));
      if (std::find(members.begin(), members.end(), true) == members.end()) return;
      result.subsets.push_back(subset(name, members));
    };
    add("all", [](const LabelPrompt&) { return true; });
    add("take", [](const LabelPrompt& prompt) { return prompt.unseen == "take"; });
    add("pair", [](const LabelPrompt& prompt) { return prompt.unseen == "pair"; });
    add("rare", [&](const LabelPrompt& prompt) {
      const auto found = facts_.training_clips.find(prompt.content);
      return found == facts_.training_clips.end() || found->second < kRareClips;
    });
    result.multimodality = measured_multimodality();
    for (size_t i = 0; i < run_.jobs.size(); ++i) {
      if (run_.jobs[i].modality) continue;
      const GenerationOutcome& outcome = run_.outcomes[i];
      LabelCount& count = result.contents[outcome.content];
      ++count.motions;
      count.right += outcome.motion.right;
      if (outcome.motion.physical.finite) ++count.nearest[outcome.motion.nearest_content];
    }
    return result;
  }

 private:
  GenerationSubset subset(const std::string& name, const std::vector<bool>& members) const {
    GenerationSubset result;
    result.name = name;
    for (size_t i = 0; i < members.size(); ++i) {
      if (!members[i]) continue;
      ++result.prompts;
      const auto found = gallery_.contents().find(run_.prompts[i].content);
      if (found == gallery_.contents().end()) continue;
      result.chance += found->second / static_cast<double>(gallery_.size());
    }
    result.chance /= result.prompts;
    result.generated = figures(generated_, members);
    result.real = figures(real_table_, members);
    return result;
  }

  MotionFigures figures(const MotionTable& table, const std::vector<bool>& members) const {
    MotionFigures result;
    std::vector<PhysicalMetrics> physical;
    std::vector<int> judged;
    for (const auto& motions : table) {
      for (size_t i = 0; i < motions.size(); ++i) {
        if (!members[i]) continue;
        judged.push_back(motions[i]->right ? 1 : 0);
        physical.push_back(motions[i]->physical);
        count_side(run_.prompts[i].text, motions[i]->shown_side, result.sides);
      }
    }
    result.content = content_accuracy(judged, {});
    result.physical = pipeline::summarise_physical(physical);
    result.captions = pair_figures(table, members, DistinctBy::captions);
    result.labels = pair_figures(table, members, DistinctBy::labels);
    return result;
  }

  GenerationFigures pair_figures(const MotionTable& table, const std::vector<bool>& members,
                                 DistinctBy distinct) const {
    const at::Tensor real = embedding_rows(real_table_.front(), text_.size(1));
    std::vector<BatchKeys> keys;
    for (const LabelPrompt& prompt : run_.prompts) {
      keys.push_back(batch_keys(facts_.clips.at(prompt.clip_id), prompt.text, distinct));
    }
    std::vector<EmbeddedPairs> runs;
    for (const auto& motions : table) {
      runs.push_back({text_, embedding_rows(motions, text_.size(1)), real, keys});
    }
    GenerationFigureOptions measure;
    measure.draws = options_.draws;
    measure.batch = options_.batch;
    return measure_pairs(runs, measure, members);
  }

  Figure measured_multimodality() const {
    std::vector<const JudgedMotion*> motions;
    for (size_t i = 0; i < run_.jobs.size(); ++i) {
      if (run_.jobs[i].modality) motions.push_back(&run_.outcomes[i].motion);
    }
    std::vector<double> draws;
    const int repeats = run_.protocol.at("modality_repeats");
    if (!motions.empty() && repeats >= options_.modality_picks) {
      const at::Tensor rows =
          embedding_rows(motions, text_.size(1)).reshape({-1, repeats, text_.size(1)});
      for (int draw = 0; draw < options_.draws; ++draw) {
        CounterRandom random(kPickStream, static_cast<uint64_t>(draw));
        draws.push_back(multimodality(rows, options_.modality_picks, random));
      }
    }
    return figure_of(draws);
  }

  const GenerationRun& run_;
  const JudgeGallery& gallery_;
  GenerationReportOptions options_;
  PromptFacts facts_;
  at::Tensor text_;
  std::vector<JudgedMotion> real_;
  MotionTable real_table_, generated_;
};

}  // namespace

GenerationReport report_generation(const GenerationRun& run, const db::Database& database,
                                   const JudgeGallery& gallery, const Evaluator& evaluator,
                                   const GenerationReportOptions& options) {
  if (run.outcomes.size() != run.jobs.size()) throw Error("the run is not finished");
  return ReportBuilder(run, database, gallery, evaluator, options).report();
}

}  // namespace remomask::evaluation
