#include "tools/evidence_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "formats/sidecar.h"
#include "remomask/error.h"

namespace remomask::tools {

namespace {

void append_hit(std::string& line, const std::string& name, double similarity) {
  line += line.empty() ? "retrieved: " : ", ";
  line += fmt::format("{} ({:.2f})", name, similarity);
}

std::string stored_evidence_line(const nlohmann::json& evidence) {
  std::string line;
  for (const auto& hit : evidence) {
    // Version 0.1 did not always say which hits were read: then all were.
    if (!hit.value("read", true)) continue;
    const auto probability = hit.find("probability");
    const bool known = probability != hit.end() && probability->is_number();
    append_hit(line, hit.at("clip").get<std::string>(),
               known ? probability->get<double>() : hit.at("similarity").get<double>());
  }
  return line;
}

SidecarText text_of_sidecar(const nlohmann::json& sidecar) {
  if (!sidecar.contains("segments") || !sidecar.at("segments").is_array()) {
    return {sidecar.at("prompt").get<std::string>(),
            stored_evidence_line(parse_json(sidecar.at("evidence").get<std::string>()))};
  }
  const nlohmann::json& segments = sidecar.at("segments");
  SidecarText text;
  for (const auto& segment : segments) {
    text.title += (text.title.empty() ? "" : "; ") + segment.at("sentence").get<std::string>();
  }
  if (segments.size() == 1) {
    text.subtitle = stored_evidence_line(segments.front().at("evidence"));
  }
  return text;
}

}  // namespace

std::string evidence_line(const std::vector<Evidence>& evidence) {
  std::string line;
  for (const Evidence& entry : evidence) {
    if (entry.use != EvidenceUse::read) continue;
    append_hit(line, entry.hit.clip.name,
               entry.hit.probability.value_or(static_cast<double>(entry.hit.similarity)));
  }
  return line;
}

std::string evidence_refusal(const std::vector<Evidence>& evidence) {
  const bool wordless = std::all_of(evidence.begin(), evidence.end(), [](const Evidence& entry) {
    return entry.use == EvidenceUse::no_captions;
  });
  return wordless ? "made from the text alone; the retrieved clips have no captions, without which "
                    "they cannot be read (remomask db tag --set-caption adds one)"
                  : "made from the text alone; none of the retrieved motions fits";
}

std::string words_text(const std::vector<QueryWord>& words,
                       const std::vector<CorrectedWord>& corrected) {
  std::string text;
  for (const CorrectedWord& word : corrected) {
    text += fmt::format("read \"{}\" as \"{}\"; ", word.typed, word.read);
  }
  std::string missing;
  for (const QueryWord& word : words) {
    if (word.covered >= kCoveredWord) continue;
    missing += fmt::format("{}\"{}\"", missing.empty() ? "" : ", ", word.word);
  }
  if (!missing.empty()) text += "nothing in this database shows " + missing;
  if (text.ends_with("; ")) text.resize(text.size() - 2);
  return text;
}

std::string language_text(const std::string& language) {
  if (language.empty()) return "";
  return fmt::format("this looks like {}; remomask understands English: translate the sentence",
                     language);
}

SidecarText read_sidecar_text(const std::string& motion_path) {
  const auto sidecar = formats::read_sidecar(motion_path);
  if (!sidecar) return {};
  try {
    return text_of_sidecar(*sidecar);
  } catch (const nlohmann::json::exception& error) {
    throw FileError(formats::sidecar_path(motion_path), 0,
                    "is not what generate writes: " + json_reason(error));
  }
}

}  // namespace remomask::tools
