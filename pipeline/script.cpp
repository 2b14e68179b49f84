#include "pipeline/script.h"

#include <fmt/format.h>
#include <torch/types.h>

#include <algorithm>
#include <charconv>

#include "base/random.h"
#include "base/time.h"
#include "generator/token_windows.h"
#include "pipeline/motion_finish.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "text/encoding.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {

namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view without_comment(std::string_view line) {
  for (size_t i = line.find('#'); i != std::string_view::npos; i = line.find('#', i + 1)) {
    if (i == 0 || kBlanks.find(line[i - 1]) != std::string_view::npos) return line.substr(0, i);
  }
  return line;
}

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// Whether a word is meant as seconds though it is no number: "2,5", "3s", "2.5sec".
bool looks_like_seconds(std::string_view word) {
  const size_t digits = word.find_first_not_of("0123456789.,");
  if (word.empty() || word[0] < '0' || word[0] > '9') return false;
  if (digits == std::string_view::npos) return true;
  const std::string_view unit = word.substr(digits);
  return unit == "s" || unit == "sec" || unit == "secs" || unit == "seconds";
}

ScriptLine parse_line(std::string_view text, const std::string& path, long number) {
  ScriptLine result;
  result.line = number;
  const std::string_view first = text.substr(0, text.find_first_of(kBlanks));
  double seconds = 0;
  const char* end = first.data() + first.size();
  const auto read = std::from_chars(first.data(), end, seconds);
  if (read.ec != std::errc() || read.ptr != end) {
    if (looks_like_seconds(first)) {
      throw FileError(path, number,
                      fmt::format("\"{}\" is no number of seconds; write it with a decimal point "
                                  "and without a unit, like 2.5",
                                  first));
    }
    result.sentence = text;
    return result;
  }
  if (!(seconds >= kMinMotionSeconds && seconds <= kMaxMotionSeconds)) {
    throw FileError(path, number,
                    fmt::format("a sentence lasts {:g} to {:g} seconds, not {}", kMinMotionSeconds,
                                kMaxMotionSeconds, first));
  }
  result.seconds = seconds;
  result.sentence = trimmed(text.substr(first.size()));
  if (result.sentence.empty()) {
    throw FileError(path, number,
                    fmt::format("there is no sentence behind the {} seconds; write \"SECONDS  "
                                "sentence\" or a sentence alone",
                                first));
  }
  return result;
}

void check_sentence(const ScriptLine& line, const std::string& path) {
  try {
    text::normalise_prompt(line.sentence);
  } catch (const Error& error) {
    throw FileError(path, line.line, error.what());
  }
}

}  // namespace

std::vector<ScriptLine> parse_script(std::string_view script, const std::string& path) {
  const std::string decoded = text::utf8_lines(std::string(script));
  std::string_view text = decoded;
  std::vector<ScriptLine> lines;
  long number = 0;
  while (!text.empty()) {
    ++number;
    const size_t end = text.find('\n');
    const std::string_view line = trimmed(without_comment(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty()) continue;
    lines.push_back(parse_line(line, path, number));
    check_sentence(lines.back(), path);
  }
  if (lines.empty()) {
    throw FileError(path, 0, "holds no sentence; write one a line, with its seconds before it");
  }
  return lines;
}

}  // namespace remomask

namespace remomask::pipeline {

namespace {

/// Frames of every segment; throws Error for lengths out of range.
std::vector<MadeSegment> lay_out(const Generator& generator,
                                 const std::vector<ScriptSegment>& segments,
                                 const GenerateOptions& options) {
  std::vector<MadeSegment> result;
  int frames = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    MadeSegment made;
    made.first = frames;
    frames += motion_frames(segments[i].seconds, generator.read_hits(segments[i].hits, options),
                            generator.skeleton().fps);
    made.last = frames;
    made.seed = i == 0 ? options.seed : mix_seed(options.seed, i);
    result.push_back(made);
  }
  return result;
}

/// Fills token frames [begin, end), and the seam before them, with the best candidate.
void fill_segment(const Generator& generator, TokenCanvas& canvas, int64_t begin, int64_t end,
                  const ScriptSegment& segment, const ScriptOptions& options, MadeSegment& made,
                  GenerationTimes& times, const Monitor& monitor) {
  const int64_t from = std::max<int64_t>(0, begin - options.seam_tokens);
  const int64_t seen = std::max<int64_t>(0, from - generator::kContextTokens);
  canvas.known.slice(0, from, begin).fill_(false);
  const uint64_t first_seed = made.seed;
  Monitor stop_only;  // The progress of a script counts sentences.
  stop_only.stop = monitor.stop;
  TokenCanvas best;
  for (int i = 0; i < options.candidates; ++i) {
    TokenCanvas candidate{canvas.tokens.clone(), canvas.known.clone()};
    GenerateOptions generate = options.generate;
    generate.seed = i == 0 ? first_seed : mix_seed(first_seed, static_cast<uint64_t>(i), 1);
    const FillReport filled = generator.fill(candidate, from, end, segment.sentence, segment.hits,
                                             generate, &times, stop_only);
    double score = 0;
    if (options.candidates > 1) {
      Motion piece = generator.decode(candidate.tokens.slice(0, seen, end), generate.held_feet);
      score = options.judge(segment.sentence, piece,
                            static_cast<int>(begin - seen) * static_cast<int>(kFramesPerToken));
    }
    if (i > 0 && score <= made.score) continue;
    made.score = score;
    made.seed = generate.seed;
    made.hits_used = filled.hits_used;
    made.followed = filled.followed;
    best = candidate;
  }
  canvas = best;
}

}  // namespace

ScriptMotion generate_script(const Generator& generator, const std::vector<ScriptSegment>& segments,
                             const ScriptOptions& options, const Monitor& monitor) {
  if (segments.empty()) throw Error("a script needs at least one sentence");
  if (options.seam_tokens < 0) throw Error("a seam cannot have fewer than no tokens");
  if (options.candidates < 1) throw Error("a segment needs at least one candidate");
  ScriptMotion result;
  result.segments = lay_out(generator, segments, options.generate);
  const int frames = result.segments.back().last;
  const int64_t all_tokens = (frames + kFramesPerToken - 1) / kFramesPerToken;
  TokenCanvas canvas = generator.canvas(all_tokens);
  int64_t begin = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    if (monitor.stop_requested()) {
      throw Interrupted(fmt::format("stopped before sentence {} of {}", i + 1, segments.size()));
    }
    MadeSegment& made = result.segments[i];
    const int64_t end =
        i + 1 == segments.size() ? all_tokens : (made.last + kFramesPerToken / 2) / kFramesPerToken;
    fill_segment(generator, canvas, begin, end, segments[i], options, made, result.times, monitor);
    begin = end;
    monitor.report({"generate", static_cast<double>(i + 1), static_cast<double>(segments.size()),
                    segments[i].sentence});
  }
  result.tokens = canvas.tokens;
  result.motion = slice(generator.decode(canvas.tokens, options.generate.held_feet), 0, frames);
  lift_to_floor_smoothly(result.motion, generator.skeleton());
  return result;
}

}  // namespace remomask::pipeline
