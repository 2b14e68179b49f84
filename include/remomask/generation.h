#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "remomask/export.h"
#include "remomask/motion.h"
#include "remomask/search.h"

namespace remomask {

/// How tokens are drawn from what the networks predict.
struct SamplingOptions {
  int steps = 10;             ///< passes of the masked transformer
  double guidance = 4;        ///< w of un + w (con - un); the papers' scale s is w - 1
  double temperature = 1;     ///< of the sampled codes; 0: always the likeliest code
  double top_share = 0.1;     ///< share of the codes that can be sampled
  double score_noise = 0;     ///< Gumbel noise on the log-confidences, annealed to 0
  int correction_rounds = 0;  ///< extra passes that redraw the least likely tenth
  double residual_guidance = 3;
  double residual_temperature = 1;
};

/// How the length of a motion is chosen if none is asked for.
enum class LengthRule {
  evidence,  ///< the median of the retrieved motions that are read
  likely,    ///< the likeliest length of motions like the sentence
  sample,    ///< a length drawn from their distribution by the seed
};

struct GenerateOptions {
  /// Kept to the frame, 1 to 600 s. Motions longer than 9.8 s are generated piece by piece.
  std::optional<double> seconds;
  LengthRule length = LengthRule::evidence;  ///< used if `seconds` is not set
  uint64_t seed = 0;                         ///< the same seed gives the same motion
  int best_of = 1;              ///< candidates to generate; the best-scoring one is returned
  ClipFilter evidence;          ///< clips that may be retrieved
  bool use_retrieval = true;    ///< false: generate from the sentence alone
  bool read_untrusted = false;  ///< also read hits that the model's evidence gate rejects
  /// Share of the token frames that keep the codes of one retrieved motion, reduced where the
  /// evidence gate trusts it less. 0: none; 1: that motion itself, through the tokenizer.
  double follow = 0.75;
  /// Also measure what each hit that was read contributed (Evidence::influence). Costs one
  /// further generation per hit.
  bool influence = false;
  bool held_feet = true;  ///< keep standing feet in place and swinging feet off the floor
  SamplingOptions sampling;
};

/// Frames [first, last) of some body parts (SearchQuery::parts); empty: the whole body.
struct EditSpan {
  int first = 0, last = 0;
  std::vector<std::string> parts;
};

struct EditOptions : GenerateOptions {
  EditOptions() { follow = 0; }  // What is edited joins what stays, not a retrieved motion.

  int extend_frames = 0;  ///< frames to append to the motion
  int fade = 6;           ///< frames at the edges of a span that blend old and new, 1 to 40
};

/// A sentence of a script.
struct ScriptLine {
  std::string sentence;
  std::optional<double> seconds;  ///< 1 to 600; unset: as in GenerateOptions::length
  long line = 0;                  ///< line number in the file, from 1; 0: not from a file
};

/// Reads a script with one "SECONDS  sentence" or "sentence" per line. Empty lines are skipped,
/// and so is everything after a # at the start of a line or after a blank. A line that begins
/// with a number begins with its seconds. Throws FileError with the line number for seconds out
/// of range, a missing sentence or an empty script; `path` only appears in messages.
REMOMASK_API std::vector<ScriptLine> parse_script(std::string_view text, const std::string& path);

/// Whether the generator read a retrieved motion, and if not, why.
enum class EvidenceUse {
  read,
  untrusted,        ///< the evidence gate gave it no trust
  after_untrusted,  ///< a better hit was not trusted, and reading stops there
  no_captions,      ///< the clip has no captions, and the networks read text and motion together
};

/// Name of the enumerator: "read", "untrusted", ...
REMOMASK_API const char* evidence_use_name(EvidenceUse use);

/// A retrieved motion and its part in what was generated.
struct Evidence {
  MotionHit hit;                   ///< clip, captions, licence, similarity to the sentence
  double caption_similarity = -1;  ///< cosine of the sentence and the clip's mean caption
  double trust = 0;                ///< how far the generator may follow it, 0 to 1
  EvidenceUse use = EvidenceUse::read;
  double followed_share = 0;        ///< share of the token frames that started as this motion
  std::optional<double> influence;  ///< share of the base tokens that change without this hit
};

/// A motion that was generated to choose from.
struct Candidate {
  uint64_t seed = 0;
  double similarity = 0;   ///< cosine of sentence and motion, by the retriever
  double skate = 0;        ///< foot skate, m/s
  double jerk = 0;         ///< m/s^3
  double penetration = 0;  ///< depth of the lowest foot below the floor, m
  double bend = 0;         ///< of an edit: path shift in m + path turn in radians
  double score = 0;        ///< what candidates are ranked by; higher is better
};

/// How long a motion became, and why.
struct LengthChoice {
  bool given = true;                       ///< GenerateOptions::seconds was set
  LengthRule rule = LengthRule::evidence;  ///< the rule that chose, unless `given`
  int neighbours = 0;                      ///< clips behind the distribution (likely, sample)
  double likely_seconds = 0;               ///< likeliest length (likely, sample)
  /// Probabilities of 0, 1, 2 ... token frames of 0.2 s (likely, sample).
  std::vector<double> distribution;
};

/// Wall-clock times in seconds.
struct GenerationTimes {
  double text = 0, base = 0, residual = 0, decode = 0, finish = 0;
};

/// What every generated motion comes with.
struct Provenance {
  std::string sentence;
  uint64_t seed = 0;                  ///< as asked for
  uint64_t candidate_seed = 0;        ///< of the candidate that was returned
  std::vector<Candidate> candidates;  ///< best first; empty for a single candidate
  std::vector<Evidence> evidence;     ///< best hit first
  std::vector<QueryWord> words;       ///< of the sentence, and whether the database has them
  std::string generator;              ///< hash of the model, and all settings that matter
  std::string database;               ///< UUID of the database
};

struct GeneratedMotion : Provenance {
  Motion motion;  ///< uniform bone lengths, not below the floor, starts at the origin facing +Z
  LengthChoice length;
  GenerationTimes times;
};

/// Frames [first, last) of one body part that were generated.
struct EditedCells {
  std::string part;
  int first = 0, last = 0;
};

struct EditedMotion : Provenance {
  Motion motion;         ///< in the place and size of the original
  std::string original;  ///< name of the edited file; set by the caller, kept by save_motion()
  std::vector<EditedCells> cells;
  int64_t tokens = 0;            ///< cells of the token map ...
  int64_t tokens_sampled = 0;    ///< ... and how many of them were sampled
  double path_shift_metres = 0;  ///< how far the generated path was moved to meet both ends
  double path_turn_degrees = 0;  ///< how far it was turned
  GenerationTimes times;
};

/// A sentence of a script and what became of it.
struct ScriptedSegment {
  std::string sentence;
  int first = 0, last = 0;      ///< frames [first, last) of the whole motion
  uint64_t candidate_seed = 0;  ///< of the candidate that was chosen
  double score = 0;             ///< of that candidate; 0 for a single candidate
  std::vector<Evidence> evidence;
  std::vector<QueryWord> words;
  double lowest_foot = 0;              ///< m, lowest foot joint over the frames of the segment
  double highest_lowest_foot = 0;      ///< m, height of the lower foot where it is highest
  std::optional<double> jerk_at_seam;  ///< m/s^3, at the seam before it; unset for the first
};

/// How far a motion is from what a body can do. Zero is perfect, except for `floating_share`,
/// `contact_share` and `jerk`, which are to be compared with those of real motions.
struct PhysicalMetrics {
  bool finite = true;           ///< no NaN or infinity; if there is one, the others are 0
  double bone_length_mean = 0;  ///< |length - uniform| / uniform, over bones and frames
  double bone_length_max = 0;   ///< the worst bone of the worst frame
  double penetration_mean = 0;  ///< m below the floor of the lowest foot joint, over frames
  double penetration_max = 0;   ///< m
  double floating_share = 0;    ///< share of the frames with the lowest foot joint above 10 cm
  double contact_share = 0;     ///< share of the steps of a toe that begin and end below 5 cm
  double foot_skate = 0;        ///< m/s, horizontal speed of the toes in those steps
  double foot_skate_ratio = 0;  ///< share of those steps above 0.5 m/s
  double jerk = 0;              ///< m/s^3, third difference of the positions, mean over joints
};

struct ScriptedMotion {
  Motion motion;  ///< uniform bone lengths, starts at the origin, not below the floor
  std::vector<ScriptedSegment> segments;
  uint64_t seed = 0;
  std::string generator, database;  ///< as in Provenance
  PhysicalMetrics physical;
  double jerk_of_real = 0;  ///< mean jerk of the database's clips, m/s^3; 0: no such clip
  /// Mean and maximum jerk at the seams, m/s^3; unset for a single sentence.
  std::optional<double> jerk_at_seams, jerk_at_worst_seam;
  GenerationTimes times;
};

}  // namespace remomask
