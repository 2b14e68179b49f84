#include "synthetic/procedural.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hash.h"
#include "base/random.h"
#include "base/time.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "synthetic/procedural_captions.h"
#include "synthetic/procedural_kinds.h"

namespace remomask::synthetic {

namespace {

const char* const kStyles[] = {"neutral", "energetic", "tired", "old"};

/// Smooth noise: three slow sines with the individual's own phases.
class SmoothNoise {
 public:
  explicit SmoothNoise(CounterRandom& random) {
    for (double& phase : phases_) phase = random.uniform(0, 2 * std::numbers::pi);
  }
  double operator()(double t) const {
    return std::sin(1.9 * t + phases_[0]) * 0.5 + std::sin(3.3 * t + phases_[1]) * 0.3 +
           std::sin(5.1 * t + phases_[2]) * 0.2;
  }

 private:
  double phases_[3];
};

/// What makes two people different: carriage of arms and head, and unrest.
void individualize(Poses& poses, uint64_t variation) {
  CounterRandom random(variation, 1);
  const double nod = random.uniform(-4, 5), bend = random.uniform(-2, 3);
  const double abduct = random.uniform(-2, 5), elbow = random.uniform(-6, 10);
  const SmoothNoise trunk(random), side(random), head(random), gaze(random);
  const SmoothNoise arms[2] = {SmoothNoise(random), SmoothNoise(random)};
  for (size_t f = 0; f < poses.size(); ++f) {
    const double t = seconds_of(f);
    BodyPose& pose = poses[f];
    pose.nod += nod + 1.5 * head(t);
    pose.look += 2 * gaze(t);
    pose.bend += bend + 0.8 * trunk(t);
    pose.lean += 0.8 * side(t);
    for (int s = 0; s < 2; ++s) {
      pose.arms[s].abduct += abduct;
      pose.arms[s].flex += 1.6 * arms[s](t);
      pose.arms[s].elbow =
          std::clamp(pose.arms[s].elbow + elbow + 1.6 * arms[s](t + 4), 2.0, 145.0);
    }
  }
}

void apply_style(Poses& poses, const std::string& style) {
  const bool old = style == "old";
  if (!old && style != "tired") return;
  for (BodyPose& pose : poses) {
    const double bend = old ? 26 : 12;
    pose.bend += bend;
    pose.nod += old ? -10 : 20;
    pose.pelvis.y() -= old ? 0.045 : 0.015;
    for (ArmPose& arm : pose.arms) {
      // Arms at the body hang down in spite of the bent back.
      const double hanging = std::clamp(1 - (std::abs(arm.flex) + arm.abduct) / 90, 0.0, 1.0);
      arm.flex += 0.8 * bend * hanging;
      if (old) arm.elbow = std::min(arm.elbow + 14 * hanging, 145.0);
    }
  }
}

const ProceduralKind& find_kind(const std::string& name) {
  for (const ProceduralKind& kind : procedural_kind_table()) {
    if (kind.name == name) return kind;
  }
  throw Error("no procedural motion is called \"" + name + "\"; procedural_kinds() lists them");
}

void check_range(const std::string& kind, const char* what, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error("procedural motion " + kind + ": " + what + " is " + std::to_string(value) +
              ", but must lie in " + std::to_string(low) + " .. " + std::to_string(high));
}

void check_parameters(const ProceduralKind& kind, const ProceduralParameters& p) {
  check_range(kind.name, "amplitude", p.amplitude, 0.5, 1.3);
  check_range(kind.name, "count", p.count, 1, kind.most);
  if (kind.low_speed > 0) check_range(kind.name, "speed", p.speed, 0.3, 4.8);
  if (kind.longest > 0) check_range(kind.name, "duration", p.duration, kind.shortest, kind.longest);
  if (std::find(std::begin(kStyles), std::end(kStyles), p.style) == std::end(kStyles)) {
    throw Error("procedural motion " + kind.name + ": style \"" + p.style +
                "\" is not neutral, energetic, tired or old");
  }
  if (!kind.styles && p.style != "neutral") {
    throw Error("procedural motion " + kind.name + " has no style but neutral");
  }
}

std::vector<std::string> style_adverbs(const std::string& style, CounterRandom& random) {
  static const char* const words[3][2] = {
      {"energetically", "with a lot of energy"},
      {"tiredly", "with a hanging head, looking tired"},
      {"like an old person", "with a bent back like an elderly person"}};
  const size_t which = random.below(2);
  for (size_t i = 0; i < 3; ++i) {
    if (style == kStyles[i + 1]) return {words[i][which]};
  }
  return {};
}

std::string split_of(const std::string& name) {
  const unsigned long bucket = std::stoul(content_hash(name).substr(0, 7), nullptr, 16) % 100;
  return bucket < 80 ? "train" : bucket < 88 ? "val" : "test";
}

ProceduralParameters choose_parameters(const ProceduralKind& kind, uint64_t seed) {
  CounterRandom random(seed, 0);
  ProceduralParameters p;
  p.variation = random.bits() >> 16;
  const double fast = random.uniform();
  if (kind.styles && random.uniform() < 0.45) p.style = kStyles[1 + random.below(3)];
  p.amplitude = p.style == "energetic" ? random.uniform(1.05, 1.2) : random.uniform(0.85, 1.1);
  if (kind.low_speed > 0) {
    p.speed = kind.low_speed + (kind.high_speed - kind.low_speed) * fast;
    if (p.style == "energetic") p.speed *= 1.15;
    if (p.style == "tired") p.speed *= 0.8;
    if (p.style == "old") p.speed *= 0.62;
    p.speed = std::max(p.speed, 0.3);
  }
  p.count = 1 + static_cast<int>(random.below(kind.most));
  if (kind.longest > 0) p.duration = random.uniform(kind.shortest, kind.longest);
  p.from_stand = random.uniform() < 0.65;
  return p;
}

}  // namespace

const std::vector<std::string>& procedural_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const ProceduralKind& kind : procedural_kind_table()) all.push_back(kind.name);
    return all;
  }();
  return names;
}

ProceduralClip make_procedural_clip(const std::string& name,
                                    const ProceduralParameters& parameters) {
  const ProceduralKind& kind = find_kind(name);
  ProceduralParameters p = parameters;
  if (p.speed == 0) p.speed = (kind.low_speed + kind.high_speed) / 2;
  if (kind.longest > 0) p.duration = std::clamp(p.duration, kind.shortest, kind.longest);
  check_parameters(kind, p);
  Poses poses = kind.build(p);
  individualize(poses, p.variation);
  apply_style(poses, p.style);
  ProceduralClip clip;
  clip.name = "procedural-" + name;
  motion::CanonicalOptions canonical;
  canonical.uniform_skeleton = false;  // it has these bones already
  clip.motion = motion::canonicalize(solve_body(std::move(poses)), humanml_skeleton(), canonical);
  CounterRandom random(p.variation, 2);
  clip.captions =
      write_captions(kind.phrases, kind.side, p.count, style_adverbs(p.style, random), p.variation);
  clip.labels = {{"content", name}, {"actions", kind.actions}, {"source", "procedural"}};
  nlohmann::json& chosen = clip.labels["parameters"];
  chosen = {{"style", p.style},
            {"amplitude", p.amplitude},
            {"duration", clip.motion.frames / humanml_skeleton().fps}};
  if (kind.low_speed > 0) chosen["speed"] = p.speed;
  if (kind.most > 1) chosen["count"] = p.count;
  if (!kind.side.empty()) chosen["side"] = kind.side;
  clip.split = split_of(clip.name);
  return clip;
}

std::vector<ProceduralClip> make_procedural_clips(const ProceduralOptions& options,
                                                  const Monitor& monitor) {
  const std::vector<ProceduralKind>& kinds = procedural_kind_table();
  std::vector<ProceduralClip> clips;
  for (int i = 0; i < options.count; ++i) {
    if (monitor.stop_requested())
      throw Interrupted("stopped while making motions; nothing was stored");
    monitor.report(
        {"make motions", static_cast<double>(i), static_cast<double>(options.count), ""});
    const ProceduralKind& kind = kinds[i % kinds.size()];
    ProceduralClip clip =
        make_procedural_clip(kind.name, choose_parameters(kind, mix_seed(options.seed, i)));
    const std::string number = std::to_string(i / kinds.size());
    clip.name += "-" + std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number;
    clip.split = split_of(clip.name);
    clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace remomask::synthetic
