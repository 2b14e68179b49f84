#include "search/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "index/vector_index.h"
#include "remomask/error.h"
#include "search/calibration.h"
#include "search/coverage.h"

namespace remomask::search {

namespace {

constexpr size_t kNeighbours = 8;
constexpr int64_t kSought = 96;        // with those of the clip's own group
constexpr double kTemperature = 0.05;  // of the weights of neighbours, in cosine
constexpr double kSameMeaning = 0.7;   // cosine from which two captions say the same
constexpr size_t kFewestDescribed = 40, kMostLearntFrom = 600;
constexpr double kLeastProbability = 0.01, kMostProbability = 0.99;

struct Neighbour {
  const db::Clip* clip = nullptr;
  double cosine = 0;
};

struct Proposal {
  std::string text;
  const db::Clip* from = nullptr;
  double score = 0;
};

/// The described clips by their motions.
class Describer {
 public:
  Describer(const db::Database& database, const std::string& retriever_hash,
            const std::string& encoder_hash)
      : clips_(database.clips()) {
    for (db::CaptionVector& one : database.caption_vectors(encoder_hash)) {
      vectors_.emplace(std::move(one.text), std::move(one.vector));
    }
    for (const db::Clip& clip : clips_) by_id_[clip.id] = &clip;
    std::vector<int64_t> ids;
    std::vector<float> motions;
    for (db::ClipEmbedding& one : database.embeddings(retriever_hash)) {
      const db::Clip& clip = *by_id_.at(one.clip_id);
      if (is_described(clip)) {
        ids.push_back(clip.id);
        motions.insert(motions.end(), one.motion.begin(), one.motion.end());
      }
      motions_[one.clip_id] = std::move(one.motion);
    }
    if (ids.size() < kFewestDescribed) {
      throw Error(
          fmt::format("{}: only {} of its clips have captions with vectors, from which "
                      "others could be described; at least {} are needed (remomask index "
                      "makes the vectors)",
                      database.path(), ids.size(), kFewestDescribed));
    }
    described_ = ids;
    const auto width = static_cast<int>(motions.size() / ids.size());
    index::VectorIndexOptions exact;
    exact.factory = "Flat";
    index_ = std::make_unique<index::VectorIndex>(
        index::IndexStamp{"descriptions", 0, retriever_hash}, ids, motions, width, exact);
  }

  /// Captions for a clip, best first; each says something else than those before it.
  std::vector<Proposal> propose(int64_t id, bool own_group, size_t count) const {
    const std::vector<Neighbour> near = neighbours(id, own_group);
    std::vector<Proposal> proposals;
    std::set<std::string> seen;
    for (const Neighbour& neighbour : near) {
      for (const std::string& caption : neighbour.clip->captions) {
        if (!vectors_.contains(caption) || !seen.insert(caption).second) continue;
        proposals.push_back({caption, neighbour.clip, agreement(caption, near)});
      }
    }
    std::stable_sort(
        proposals.begin(), proposals.end(),
        [](const Proposal& left, const Proposal& right) { return left.score > right.score; });
    std::vector<Proposal> different;
    for (Proposal& one : proposals) {
      const bool said = std::any_of(different.begin(), different.end(), [&](const Proposal& other) {
        return likeness(one.text, other.text) >= kSameMeaning;
      });
      if (!said) different.push_back(std::move(one));
      if (different.size() == count) break;
    }
    return different;
  }

  /// Whether a proposal says what a described clip shows.
  bool is_right(int64_t id, const Proposal& proposal) const {
    const db::Clip& clip = *by_id_.at(id);
    const std::set<std::string> own = actions(clip), other = actions(*proposal.from);
    if (!own.empty() && !other.empty()) {
      return std::any_of(own.begin(), own.end(),
                         [&](const std::string& action) { return other.contains(action); });
    }
    return std::any_of(clip.captions.begin(), clip.captions.end(), [&](const std::string& caption) {
      return vectors_.contains(caption) && likeness(caption, proposal.text) >= kSameMeaning;
    });
  }

  bool is_embedded(int64_t id) const { return motions_.contains(id); }
  const std::vector<int64_t>& described() const { return described_; }

 private:
  bool is_described(const db::Clip& clip) const {
    return std::any_of(clip.captions.begin(), clip.captions.end(),
                       [&](const std::string& caption) { return vectors_.contains(caption); });
  }

  static std::set<std::string> actions(const db::Clip& clip) {
    std::set<std::string> values;
    const auto label = clip.labels.find("actions");
    if (label == clip.labels.end() || !label->is_array()) return values;
    for (const auto& value : *label) {
      if (value.is_string()) values.insert(value.get<std::string>());
    }
    return values;
  }

  double likeness(const std::string& left, const std::string& right) const {
    return dot_product(vectors_.at(left), vectors_.at(right));
  }

  std::vector<Neighbour> neighbours(int64_t id, bool own_group) const {
    const db::Clip& clip = *by_id_.at(id);
    std::vector<Neighbour> near;
    const auto hits = index_->search(motions_.at(id).data(), 1, kSought);
    for (const index::VectorHit& hit : hits.front()) {
      const db::Clip& other = *by_id_.at(hit.clip_id);
      if (other.id == id || (!own_group && other.group == clip.group)) continue;
      near.push_back({&other, hit.similarity});
      if (near.size() == kNeighbours) break;
    }
    return near;
  }

  /// Mean over the neighbours, weighted by how alike they move, of the cosine of the caption and
  /// their nearest one, each times the cosine of the motions.
  double agreement(const std::string& caption, const std::vector<Neighbour>& near) const {
    double sum = 0, weights = 0;
    for (const Neighbour& neighbour : near) {
      const double weight = std::exp((neighbour.cosine - near.front().cosine) / kTemperature);
      double best = -1;
      for (const std::string& other : neighbour.clip->captions) {
        if (vectors_.contains(other)) best = std::max(best, likeness(caption, other));
      }
      sum += weight * best * neighbour.cosine;
      weights += weight;
    }
    return sum / weights;
  }

  std::vector<db::Clip> clips_;
  std::unordered_map<int64_t, const db::Clip*> by_id_;
  std::unordered_map<std::string, std::vector<float>> vectors_;
  std::unordered_map<int64_t, std::vector<float>> motions_;
  std::vector<int64_t> described_;
  std::unique_ptr<index::VectorIndex> index_;
};

void stop_if_asked(const Monitor& monitor) {
  if (monitor.stop_requested()) throw Interrupted("describing was stopped; nothing was stored");
}

}  // namespace

Descriptions describe_clips(const db::Database& database, const std::string& retriever_hash,
                            const std::string& encoder_hash, const std::vector<int64_t>& clips,
                            const DescribeOptions& options, const Monitor& monitor) {
  const db::ReadSnapshot snapshot(database);
  const Describer describer(database, retriever_hash, encoder_hash);
  const std::vector<int64_t>& described = describer.described();
  const size_t learnt = std::min(described.size(), kMostLearntFrom);
  const auto total = static_cast<double>(learnt + clips.size());
  double done = 0;
  const auto step = [&] {
    stop_if_asked(monitor);
    monitor.report({"describe", ++done, total, "clips"});
  };
  std::vector<double> scores;
  std::vector<bool> right;
  Descriptions result;
  result.learnt_from = static_cast<int64_t>(learnt);
  for (size_t i = 0; i < learnt; ++i) {
    const int64_t id = described[i * described.size() / learnt];
    const std::vector<Proposal> proposals = describer.propose(id, false, options.captions);
    for (size_t place = 0; place < proposals.size(); ++place) {
      scores.push_back(proposals[place].score);
      right.push_back(describer.is_right(id, proposals[place]));
      if (place == 0 && right.back()) result.share_right += 1 / static_cast<double>(learnt);
    }
    step();
  }
  if (scores.empty()) {
    throw Error(database.path() +
                ": all described clips are of one group, so that nothing can be learnt from them");
  }
  const Calibration calibration = fit_calibration(scores, right);
  for (const int64_t id : clips) {
    const size_t before = result.guesses.size();
    if (describer.is_embedded(id)) {
      for (const Proposal& proposal : describer.propose(id, true, options.captions)) {
        const double probability = std::clamp(calibration.probability(proposal.score),
                                              kLeastProbability, kMostProbability);
        if (probability < options.min_probability) continue;
        result.guesses.push_back({id, proposal.text, probability});
      }
    }
    if (result.guesses.size() == before) ++result.undescribed;
    step();
  }
  return result;
}

}  // namespace remomask::search
