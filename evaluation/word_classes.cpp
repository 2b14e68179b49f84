#include "evaluation/word_classes.h"

#include <initializer_list>
#include <unordered_map>

namespace remomask::evaluation {

namespace {

using ClassTable = std::unordered_map<std::string, WordClass>;

ClassTable make_listed_words() {
  ClassTable table;
  // emplace() keeps the first entry: the order of the lists decides.
  const auto add = [&](WordClass kind, std::initializer_list<const char*> words) {
    for (const char* word : words) table.emplace(word, kind);
  };
  add(WordClass::place, {"left", "right", "clockwise", "counterclockwise", "anticlockwise",
                         "forward", "back", "backward", "up", "down", "straight", "curve"});
  add(WordClass::body, {"arm", "chin", "foot", "feet", "face", "hand", "mouth", "leg", "waist",
                        "eye", "knee", "shoulder", "thigh"});
  add(WordClass::object, {"stair", "dumbbell", "chair", "window", "floor", "car", "ball",
                          "handrail", "baseball", "basketball"});
  add(WordClass::act,
      {"walk",    "run",     "swing", "pick",   "bring",   "kick",   "put",  "squat", "throw",
       "hop",     "dance",   "jump",  "turn",   "stumble", "stop",   "sit",  "lift",  "lower",
       "raise",   "wash",    "stand", "kneel",  "stroll",  "rub",    "bend", "flap",  "jog",
       "balance", "shuffle", "lean",  "rotate", "spin",    "spread", "climb"});
  add(WordClass::description, {"slowly", "carefully", "fast", "careful", "slow", "quickly", "happy",
                               "angry", "sad", "happily", "angrily", "sadly"});
  return table;
}

ClassTable make_function_words() {
  ClassTable table;
  const auto add = [&](WordClass kind, std::initializer_list<const char*> words) {
    for (const char* word : words) table.emplace(word, kind);
  };
  add(WordClass::determiner, {"a", "an", "the", "this", "that", "these", "those", "both", "each"});
  add(WordClass::adposition, {"in",      "on",     "at",     "to",     "with", "from",    "of",
                              "by",      "over",   "above",  "around", "into", "through", "toward",
                              "towards", "beside", "behind", "for",    "like", "across",  "under"});
  add(WordClass::numeral,
      {"one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"});
  add(WordClass::auxiliary, {"is", "are", "be", "was", "were", "has", "have", "can", "will"});
  add(WordClass::pronoun, {"he", "she", "it", "they", "his", "her", "its", "their", "them", "him",
                           "someone", "who", "himself", "herself", "themselves"});
  return table;
}

bool ends_with(const std::string& word, const char* ending) {
  return word.size() > 2 + std::string(ending).size() && word.ends_with(ending);
}

/// A stem as it stands, with the silent "e", and without a doubled consonant.
void add_stem(const std::string& stem, std::vector<std::string>& forms) {
  forms.push_back(stem);
  forms.push_back(stem + "e");
  const size_t size = stem.size();
  if (size > 2 && stem[size - 1] == stem[size - 2]) forms.push_back(stem.substr(0, size - 1));
}

}  // namespace

std::vector<std::string> base_forms(const std::string& word) {
  static const std::unordered_map<std::string, std::string> irregular = {
      {"ran", "run"},           {"swung", "swing"}, {"brought", "bring"}, {"threw", "throw"},
      {"thrown", "throw"},      {"sat", "sit"},     {"stood", "stand"},   {"knelt", "kneel"},
      {"bent", "bend"},         {"leant", "lean"},  {"spun", "spin"},     {"forwards", "forward"},
      {"backwards", "backward"}};
  std::vector<std::string> forms = {word};
  if (const auto found = irregular.find(word); found != irregular.end()) {
    forms.push_back(found->second);
  }
  const auto without = [&](size_t letters) { return word.substr(0, word.size() - letters); };
  if (ends_with(word, "ies")) forms.push_back(without(3) + "y");
  if (ends_with(word, "s") && !word.ends_with("ss")) forms.push_back(without(1));
  if (ends_with(word, "es")) forms.push_back(without(2));
  if (ends_with(word, "ing")) add_stem(without(3), forms);
  if (ends_with(word, "ed")) add_stem(without(2), forms);
  return forms;
}

WordClass word_class(const std::string& word) {
  static const ClassTable listed = make_listed_words(), function_words = make_function_words();
  for (const std::string& form : base_forms(word)) {
    if (const auto found = listed.find(form); found != listed.end()) return found->second;
  }
  const auto found = function_words.find(word);
  return found != function_words.end() ? found->second : WordClass::other;
}

}  // namespace remomask::evaluation
