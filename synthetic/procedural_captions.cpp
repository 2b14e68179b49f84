#include "synthetic/procedural_captions.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "base/random.h"
#include "remomask/error.h"

namespace remomask::synthetic {

namespace {

const char* const kNumberWords[] = {"zero", "one", "two", "three", "four", "five", "six"};

bool ends_with_any(std::string_view word, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view e) { return word.ends_with(e); });
}

std::string times_word(int count) {
  if (count == 1) return "once";
  if (count == 2) return "twice";
  return std::string(kNumberWords[count]) + " times";
}

/// Fills the slots and inflects the verbs of one phrase.
std::string fill_phrase(const std::string& phrase, VerbForm form, const std::string& side,
                        int count) {
  std::string out;
  for (size_t i = 0; i < phrase.size(); ++i) {
    if (phrase[i] != '{' && phrase[i] != '[') {
      out += phrase[i];
      continue;
    }
    const size_t end = phrase.find(phrase[i] == '{' ? '}' : ']', i);
    const std::string word = phrase.substr(i + 1, end - i - 1);
    if (phrase[i] == '{')
      out += inflect(word, form);
    else if (word == "side")
      out += side;
    else if (word == "n")
      out += count == 1 ? "a" : kNumberWords[count];
    else if (word == "s" || word == "es")
      out += count == 1 ? "" : word;
    else if (word == "times")
      out += times_word(count);
    else
      throw Error("caption slot [" + word + "] is not known");
    i = end;
  }
  return out;
}

}  // namespace

std::string inflect(const std::string& verb, VerbForm form) {
  if (form == VerbForm::base) return verb;
  if (form == VerbForm::third_person) {
    if (ends_with_any(verb, {"ch", "sh", "s", "x", "o"}) && verb != "tiptoe") return verb + "es";
    return verb + "s";
  }
  for (const char* doubled :
       {"run", "jog", "sit", "squat", "clap", "step", "sidestep", "stop", "hop", "let", "get"}) {
    if (verb == doubled) return verb + verb.back() + "ing";
  }
  if (verb.ends_with("e") && !verb.ends_with("oe")) return verb.substr(0, verb.size() - 1) + "ing";
  return verb + "ing";
}

std::vector<std::string> write_captions(const std::vector<std::string>& phrases,
                                        const std::string& side, int count,
                                        const std::vector<std::string>& adverbs,
                                        uint64_t variation) {
  CounterRandom random(variation, 0xca97);
  std::string tail;
  for (const std::string& adverb : adverbs) tail += (tail.empty() ? " " : ", ") + adverb;
  static const char* const subjects[] = {"a person", "someone", "the figure", "a human",
                                         "the person"};
  const size_t first_subject = random.below(5), first_phrase = random.below(phrases.size());
  static const VerbForm forms[] = {VerbForm::third_person, VerbForm::gerund, VerbForm::base,
                                   VerbForm::third_person};
  std::vector<std::string> captions;
  const int wanted = 3 + static_cast<int>(random.below(2));
  for (int i = 0; i < wanted; ++i) {
    const std::string& phrase = phrases[(first_phrase + i) % phrases.size()];
    const std::string subject = subjects[(first_subject + i) % 5];
    std::string text = fill_phrase(phrase, forms[i], side, count) + tail + ".";
    if (forms[i] == VerbForm::third_person) text = subject + " " + text;
    if (forms[i] == VerbForm::gerund) text = subject + " is " + text;
    captions.push_back(text);
  }
  return captions;
}

}  // namespace remomask::synthetic
