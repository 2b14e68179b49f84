#include "remomask/text_to_motion.h"

#include <fmt/format.h>

#include <mutex>
#include <numbers>

#include "base/hash.h"
#include "base/process_settings.h"
#include "db/database.h"
#include "encoders/text_file.h"
#include "nn/model_file.h"
#include "nn/threads.h"
#include "pipeline/candidate_list.h"
#include "pipeline/editing.h"
#include "pipeline/evidence.h"
#include "pipeline/influence.h"
#include "pipeline/length_estimate.h"
#include "pipeline/long_motion.h"
#include "pipeline/motion_generator.h"
#include "remomask/error.h"
#include "search/motion_search.h"
#include "search/query.h"
#include "text/caption.h"

namespace remomask::pipeline {

/// Evidence from the clips of a database.
class DatabaseSource final : public EvidenceSource {
 public:
  explicit DatabaseSource(const search::MotionSearch& search) : search_(search) {}

  search::FoundClips find(const std::string& sentence, const std::vector<float>&, int k,
                          const ClipFilter& filter) const override {
    return search_.find(sentence, k, filter);
  }
  Motion motion(int64_t clip_id) const override { return search_.motion(clip_id); }

 private:
  const search::MotionSearch& search_;
};

/// The generator of a model and the hash of all its stages.
struct LoadedModel {
  Generator generator;
  std::string hash;
};

}  // namespace remomask::pipeline

namespace remomask {

namespace {

using pipeline::FoundEvidence;
using pipeline::Generator;

/// All settings that change what is generated, in one line.
std::string describe_settings(const std::string& model_hash, const GenerateOptions& options) {
  const SamplingOptions& sampling = options.sampling;
  const char* retrieval = !options.use_retrieval   ? "off"
                          : options.read_untrusted ? "all"
                                                   : "trusted";
  return fmt::format(
      "model {} steps {} guidance {:g} temperature {:g} top {:g} corrections {} "
      "residual guidance {:g} residual temperature {:g} retrieval {} follow {:g} best of {} "
      "length {} feet {}",
      model_hash, sampling.steps, sampling.guidance, sampling.temperature, sampling.top_share,
      sampling.correction_rounds, sampling.residual_guidance, sampling.residual_temperature,
      retrieval, options.follow, options.best_of, pipeline::length_rule_name(options.length),
      options.held_feet ? "held and raised" : "free");
}

void check_share(double value, const char* name) {
  if (!(value >= 0 && value <= 1)) {
    throw Error(fmt::format("{} is a share from 0 to 1, not {:g}", name, value));
  }
}

void check_options(const GenerateOptions& options) {
  if (options.best_of < 1) throw Error("best_of must be at least 1");
  if (options.sampling.steps < 1) throw Error("sampling.steps must be at least 1");
  check_share(options.follow, "follow");
  check_share(options.sampling.top_share, "sampling.top_share");
}

std::vector<EditedCells> edited_cells(const motion::PartMask& mask) {
  const motion::BodyPartMap& map = motion::body_parts(humanml_skeleton());
  std::vector<EditedCells> cells;
  for (int part = 0; part < motion::kBodyParts; ++part) {
    for (const motion::FrameRun& run : motion::part_runs(mask, part)) {
      cells.push_back({map.names[static_cast<size_t>(part)], run.first, run.last});
    }
  }
  return cells;
}

}  // namespace

struct TextToMotion::Impl {
  std::string model_path, database_path;
  OpenOptions options;
  std::shared_ptr<search::WordModel> words;
  std::shared_ptr<const retriever::Retriever> retriever;
  std::string database_uuid;
  std::unique_ptr<const search::MotionSearch> opened_search;  // none without retrieval
  mutable std::mutex mutex;                                   // of `model`
  mutable std::shared_ptr<const pipeline::LoadedModel> model;

  Impl(const std::string& model_file, const std::string& database_file, const OpenOptions& open)
      : model_path(model_file),
        database_path(database_file),
        options(open),
        words(std::make_shared<search::WordModel>(search::WordModel::open(
            options.text.empty() ? encoders::text_file_of(model_file) : options.text))),
        retriever(std::make_shared<retriever::Retriever>(
            retriever::open_retriever(model_file, words->encoder))),
        database_uuid(db::Database(database_file, db::OpenMode::read_only).uuid()) {
    if (!options.retrieval) return;
    opened_search =
        std::make_unique<search::MotionSearch>(retriever, words, database_file, open.index);
  }

  const search::MotionSearch& search() const {
    if (opened_search) return *opened_search;
    throw Error("opened without retrieval: nothing can be searched or retrieved");
  }

  FoundEvidence evidence(const Generator& generator, const std::string& sentence,
                         const GenerateOptions& used) const {
    if (!used.use_retrieval) return {};
    return find_evidence(generator, pipeline::DatabaseSource(search()), sentence, used);
  }

  /// Loads the generator when it is first needed.
  std::shared_ptr<const pipeline::LoadedModel> load() const {
    const std::scoped_lock lock(mutex);
    if (model) return model;
    const auto stages = nn::load_model(model_path);
    std::string digest = database_uuid;
    for (const auto& [kind, stage] : stages) digest += nn::stage_hash(stage);
    auto loaded = std::make_shared<const pipeline::LoadedModel>(
        pipeline::LoadedModel{Generator(retriever, stages), content_hash(digest)});
    if (!options.low_memory) model = loaded;
    return loaded;
  }

  /// Sets the seconds where nothing else gives them.
  LengthChoice choose_length(const std::string& sentence, GenerateOptions& one) const {
    LengthChoice choice;
    choice.given = one.seconds.has_value();
    choice.rule = one.length;
    if (choice.given || choice.rule == LengthRule::evidence) return choice;
    std::vector<pipeline::LengthNeighbour> neighbours;
    for (const search::FoundClip& found :
         search().find(sentence, pipeline::kLengthNeighbours, one.evidence).clips) {
      neighbours.push_back({found.hit.probability.value_or(0), found.hit.clip.frames});
    }
    choice.neighbours = static_cast<int>(neighbours.size());
    choice.distribution = pipeline::length_distribution(neighbours);
    choice.likely_seconds = pipeline::estimate_seconds(choice.distribution, LengthRule::likely, 0);
    one.seconds = pipeline::estimate_seconds(choice.distribution, choice.rule, one.seed);
    return choice;
  }

  void note_provenance(const pipeline::LoadedModel& loaded, const std::string& sentence,
                       const GenerateOptions& used, Provenance& result) const {
    result.sentence = sentence;
    result.seed = used.seed;
    result.generator = describe_settings(loaded.hash, used);
    result.database = database_uuid;
  }
};

TextToMotion::TextToMotion(const std::string& model, const std::string& database,
                           const OpenOptions& options)
    : impl_(std::make_unique<Impl>(model, database, options)) {
  log_missing_settings();
}
TextToMotion::~TextToMotion() = default;
TextToMotion::TextToMotion(TextToMotion&&) noexcept = default;
TextToMotion& TextToMotion::operator=(TextToMotion&&) noexcept = default;

GeneratedMotion TextToMotion::generate(const std::string& sentence, const GenerateOptions& options,
                                       const Monitor& monitor) const {
  nn::set_compute_threads(impl_->options.threads);
  text::normalise_prompt(sentence);
  check_options(options);
  const auto loaded = impl_->load();
  const Generator& generator = loaded->generator;
  FoundEvidence found = impl_->evidence(generator, sentence, options);

  struct Made {
    pipeline::Generated generated;
    GenerateOptions options;
    LengthChoice length;
  };
  const std::vector<float> query = generator.sentence_vector(sentence);
  pipeline::CandidateList<Made> candidates(*impl_->retriever, query);
  for (const uint64_t seed : pipeline::candidate_seeds(options.seed, options.best_of)) {
    Made made;
    made.options = options;
    made.options.seed = seed;
    made.length = impl_->choose_length(sentence, made.options);
    made.generated = generator.generate(sentence, found.motions, made.options, monitor);
    const Motion motion = made.generated.motion;
    candidates.add(std::move(made), seed, motion);
  }
  Made best = candidates.take_best();
  if (options.influence) {
    note_influence(found, hit_influence(generator, sentence, found.motions, best.options,
                                        best.generated, monitor));
  }
  note_followed(found.evidence, best.generated.followed);

  GeneratedMotion result;
  impl_->note_provenance(*loaded, sentence, options, result);
  result.candidate_seed = candidates.best_seed();
  result.candidates = candidates.ranking();
  result.evidence = std::move(found.evidence);
  result.words = std::move(found.words);
  result.motion = std::move(best.generated.motion);
  result.length = std::move(best.length);
  result.times = best.generated.times;
  return result;
}

EditedMotion TextToMotion::edit(const Motion& original, std::span<const EditSpan> spans,
                                const std::string& sentence, const EditOptions& options,
                                const Monitor& monitor) const {
  nn::set_compute_threads(impl_->options.threads);
  text::normalise_prompt(sentence);
  check_options(options);
  std::vector<pipeline::CellSpan> cells;
  for (const EditSpan& span : spans) {
    cells.push_back({span.first, span.last, search::parse_body_parts(span.parts)});
  }
  const auto loaded = impl_->load();
  const Generator& generator = loaded->generator;
  FoundEvidence found = impl_->evidence(generator, sentence, options);
  pipeline::CandidateList<pipeline::Edited> candidates(*impl_->retriever,
                                                       generator.sentence_vector(sentence));
  for (const uint64_t seed : pipeline::candidate_seeds(options.seed, options.best_of)) {
    EditOptions one = options;
    one.seed = seed;
    pipeline::Edited made =
        edit_motion(generator, original, cells, sentence, found.motions, one, monitor);
    const Motion motion = made.motion;
    const double bend = made.splice.path_shift + made.splice.path_turn;
    candidates.add(std::move(made), seed, motion, bend);
  }
  pipeline::Edited best = candidates.take_best();
  note_followed(found.evidence, best.followed);

  EditedMotion result;
  impl_->note_provenance(*loaded, sentence, options, result);
  result.candidate_seed = candidates.best_seed();
  result.candidates = candidates.ranking();
  result.evidence = std::move(found.evidence);
  result.words = std::move(found.words);
  result.cells = edited_cells(best.mask);
  result.motion = std::move(best.motion);
  result.tokens = best.tokens;
  result.tokens_sampled = best.tokens_sampled;
  result.path_shift_metres = best.splice.path_shift;
  result.path_turn_degrees = best.splice.path_turn * 180 / std::numbers::pi;
  result.times = best.times;
  return result;
}

ScriptedMotion TextToMotion::script(std::span<const ScriptLine> lines,
                                    const GenerateOptions& options, const Monitor& monitor) const {
  nn::set_compute_threads(impl_->options.threads);
  check_options(options);
  for (const ScriptLine& line : lines) text::normalise_prompt(line.sentence);
  const auto loaded = impl_->load();
  ScriptedMotion result = pipeline::make_long_motion(
      loaded->generator,
      [&](const std::string& sentence) {
        return impl_->evidence(loaded->generator, sentence, options);
      },
      lines, options, monitor);
  const db::Database database(impl_->database_path, db::OpenMode::read_only);
  pipeline::measure_long_motion(result, database);
  Provenance origin;
  impl_->note_provenance(*loaded, "", options, origin);
  result.seed = options.seed;
  result.generator = origin.generator;
  result.database = origin.database;
  return result;
}

std::vector<Evidence> TextToMotion::retrieve(const std::string& sentence,
                                             const GenerateOptions& options) const {
  nn::set_compute_threads(impl_->options.threads);
  text::normalise_prompt(sentence);
  check_options(options);
  return impl_->evidence(impl_->load()->generator, sentence, options).evidence;
}

SearchAnswer TextToMotion::search(const SearchQuery& query) const {
  nn::set_compute_threads(impl_->options.threads);
  return impl_->search().search(query);
}

std::vector<CaptionHit> TextToMotion::captions_for(const SearchQuery& query) const {
  nn::set_compute_threads(impl_->options.threads);
  return impl_->search().captions_for(query);
}

std::string TextToMotion::identity(const GenerateOptions& options) const {
  return describe_settings(impl_->load()->hash, options);
}

}  // namespace remomask
