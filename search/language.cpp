#include "search/language.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "search/coverage.h"
#include "text/caption.h"
#include "text/utf8.h"
#include "text/words.h"

namespace remomask::search {

namespace {

struct Script {
  char32_t first, last;
  const char* language;
};

// The most frequent language of a script stands for the others.
constexpr Script kScripts[] = {
    {0x370, 0x3FF, "Greek"},      {0x400, 0x52F, "Russian"},   {0x590, 0x5FF, "Hebrew"},
    {0x600, 0x6FF, "Arabic"},     {0x900, 0x97F, "Hindi"},     {0xE00, 0xE7F, "Thai"},
    {0x3040, 0x30FF, "Japanese"}, {0x3400, 0x4DBF, "Chinese"}, {0x4E00, 0x9FFF, "Chinese"},
    {0xAC00, 0xD7AF, "Korean"},   {0x1100, 0x11FF, "Korean"},  {0xF900, 0xFAFF, "Chinese"}};

struct Words {
  const char* language;
  const char* words;  ///< in lower case; none that is frequent in English
};

// Function words, who moves, and what people do most. Words that English has as well ("die", "in",
// "man", "come") are left out, so that one word can decide.
constexpr Words kLanguages[] = {
    {"Spanish",
     "una un el la los las de del sobre alto que con por para hacia su sus se y e al lo esta está "
     "como muy mientras "
     "luego después persona hombre mujer niño niña alguien chico chica gente mano manos brazo "
     "brazos "
     "pierna piernas pie pies cabeza derecha derecho izquierda izquierdo adelante atrás arriba "
     "abajo "
     "suelo silla camina caminar caminando anda andar andando corre correr corriendo salta saltar "
     "saltando baila bailar bailando saluda saludar patea pateando golpea gira girar girando "
     "levanta "
     "levanta levantando sienta sentado agacha lanza tira nada nadando trepa sube baja despacio "
     "lentamente rápido rápidamente círculo círculos puñetazo patada"},
    {"French",
     "une le la les de des du est et qui que avec pour vers dans sur sa ses il elle puis très "
     "pendant en "
     "au aux un quelqu'un personne homme femme garçon fille enfant gens main mains bras jambe "
     "jambes "
     "pied pieds tête droite gauche avant arrière haut sol chaise marche marcher court courir "
     "saute "
     "sauter danse danser salue saluer frappe tourne tourner lève s'assoit s'assied assis assoit "
     "donne lance nage grimpe monte descend lentement doucement vite rapidement cercle coup poing"},
    {"German",
     "ein eine einen einem einer der das den dem und mit nach auf zu zum zur im ist sich er sie es "
     "wie dann von aus vom nicht sehr langsam schnell mann frau junge mädchen kind jemand mensch "
     "person hände arme beine bein fuß füße kopf rechts links rechten linken rechte linke rechter "
     "linker vorwärts rückwärts vorne hinten oben unten boden stuhl geht gehen läuft laufen rennt "
     "rennen springt springen tanzt tanzen winkt winken tritt treten schlägt schlagen dreht drehen "
     "hebt heben setzt sitzt steht stehen bückt verbeugt wirft schwimmt klettert kriecht kreis"},
    {"Italian",
     "uno la lo gli alto della del dei delle di che con per verso sul sulla nel nella e è si suo "
     "sua poi "
     "molto "
     "mentre un una il persona uomo donna ragazzo ragazza bambino bambina qualcuno mano mani "
     "braccio "
     "braccia gamba gambe piede piedi testa destra destro sinistra sinistro avanti indietro terra "
     "sedia cammina camminare camminando corre correre correndo salta saltare balla ballare saluta "
     "salutare calcia colpisce gira girare alza siede sedersi seduto lancia nuota sale scende "
     "lentamente piano velocemente cerchio pugno calcio"},
    {"Portuguese",
     "uma um os de alto sobre dos da das na nas nos com para pela pelo em que e seu sua depois "
     "muito enquanto ao "
     "à não é está ele ela pessoa homem mulher menino menina alguém rapaz mão mãos braço braços "
     "perna "
     "pernas pé pés cabeça direita direito esquerda esquerdo frente trás cima chão cadeira anda "
     "andar "
     "andando caminha caminhando corre correr correndo pula pular salta saltando dança dançar "
     "dançando acena acenando chuta chutando soco gira girando levanta senta sentado joga nada "
     "sobe "
     "desce devagar lentamente rápido rapidamente círculo"},
    {"Dutch",
     "een het de van tegen met naar voor op zijn haar en zich ze hij dan heel terwijl niet iemand "
     "vrouw "
     "jongen meisje mens persoon handen armen benen voet voeten hoofd rechts links rechter linker "
     "rechterhand linkerhand vooruit achteruit vloer stoel loopt lopen wandelt rent rennen springt "
     "springen danst dansen zwaait zwaaien schopt schoppen slaat draait draaien tilt gaat zitten "
     "staat staan buigt gooit zwemt klimt kruipt langzaam snel cirkel rondje"},
    {"Swedish",
     "en ett och över med som är på till för av från sig han hon den sin sitt sedan mycket inte "
     "någon "
     "människa kvinna pojke flicka barn händer handen armar armarna ben benen fot fötter huvud "
     "höger "
     "vänster framåt bakåt golvet stol går gå springer springa hoppar hoppa dansar dansa vinkar "
     "vinka sparkar sparka slår snurrar vänder lyfter sätter sitter står böjer kastar simmar "
     "klättrar kryper långsamt snabbt cirkel"},
    {"Polish",
     "się i na do ze po jest jak potem bardzo nie ktoś osoba człowiek mężczyzna kobieta chłopiec "
     "dziewczyna dziecko ręka ręką rękę ręce ramiona noga nogą nogi stopa głowa prawą prawa lewą "
     "lewa przodu tyłu podłodze krzesło krześle idzie iść chodzi chodzić biegnie biega biegać "
     "skacze "
     "skakać tańczy tańczyć macha machać kopie kopać uderza obraca podnosi siada siedzi stoi "
     "kłania "
     "rzuca pływa wspina czołga powoli wolno szybko kółko"},
    {"Turkish",
     "bir ve ile için doğru gibi sonra çok kişi insan adam kadın çocuk kız erkek biri el elini "
     "eliyle "
     "kol kolunu kollarını bacak ayak ayağıyla baş sağ sol ileri geri yere sandalyeye yürüyor "
     "yürümek "
     "yürür koşuyor koşar zıplıyor zıplar dans ediyor el sallıyor sallıyor tekme atıyor yumruk "
     "dönüyor "
     "kaldırıyor oturuyor oturur ayakta eğiliyor yüzüyor tırmanıyor yavaşça hızlı hızla"},
};

// Words above that are English, too: they speak for both.
constexpr const char* kAlsoEnglish[] = {
    "en",      "i",    "do",    "sale", "piano", "dans",  "op",     "van",    "sol",     "rent",
    "kind",    "barn", "court", "main", "pour",  "coup",  "links",  "pies",   "sin",     "ben",
    "es",      "er",   "dan",   "con",  "lance", "mano",  "na",     "person", "descend", "heel",
    "till",    "tilt", "met",   "um",   "per",   "sedan", "sitter", "adam",   "donna",   "springer",
    "bras",    "nada", "monte", "dos",  "mens",  "em",    "po",     "ve",     "pie",     "han",
    "pendant", "si",   "hon",   "il",   "son",   "mans",  "staff",  "tap",    "calf",    "est"};

// Words that English shares with several of these languages: they speak for none.
constexpr const char* kOfMany[] = {"in",  "an",  "on",   "no",  "me",  "as", "is",   "so",   "was",
                                   "man", "men", "hand", "arm", "die", "he", "over", "ball", "at"};

/// Language -> how many words of the sentence are its own.
using Counts = std::unordered_map<const char*, int>;

const std::unordered_multimap<std::string, const char*>& foreign_words() {
  static const std::unordered_multimap<std::string, const char*> known = [] {
    std::unordered_multimap<std::string, const char*> by_word;
    for (const Words& language : kLanguages) {
      std::vector<std::string> words;
      std::istringstream stream(language.words);
      for (std::string word; stream >> word;) words.push_back(word);
      std::sort(words.begin(), words.end());
      words.erase(std::unique(words.begin(), words.end()), words.end());
      for (const std::string& word : words) by_word.emplace(word, language.language);
    }
    return by_word;
  }();
  return known;
}

template <size_t count>
bool is_among(const char* const (&words)[count], const std::string& word) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

std::string language_of_script(const std::string& text) {
  std::unordered_map<std::string, int> counts;
  int letters = 0;
  for (const char32_t c : text::decode_utf8(text)) {
    const bool latin = (c >= 'a' && c <= 'z') || (c >= 0xC0 && c <= 0x24F);
    const auto script = std::find_if(std::begin(kScripts), std::end(kScripts),
                                     [&](const Script& s) { return c >= s.first && c <= s.last; });
    if (latin || script != std::end(kScripts)) ++letters;
    if (script != std::end(kScripts)) ++counts[script->language];
  }
  // Japanese writes most of its nouns in Chinese letters.
  if (counts.contains("Japanese")) {
    counts["Japanese"] += counts["Chinese"];
    counts.erase("Chinese");
  }
  for (const auto& [language, count] : counts) {
    if (2 * count > letters) return language;
  }
  return "";
}

}  // namespace

std::string foreign_language(const std::string& sentence, const KnownWords& known) {
  const std::string text = text::normalise_caption(sentence);
  const std::string by_script = language_of_script(text);
  if (!by_script.empty()) return by_script;
  Counts own;
  int words = 0, english = 0, unknown = 0, listed = 0;
  std::unordered_set<std::string> seen;
  for (const std::string& word : text::split_words(text)) {
    const auto first = static_cast<unsigned char>(word[0]);
    if (word.size() < 2 || !seen.insert(word).second || (first < 0x80 && std::isalpha(first) == 0))
      continue;
    ++words;
    const auto [begin, end] = foreign_words().equal_range(word);
    if (begin != end) ++listed;
    for (auto one = begin; one != end; ++one) ++own[one->second];
    if (is_among(kAlsoEnglish, word) || (begin == end && !is_among(kOfMany, word) &&
                                         (is_function_word(word) || known.in_captions(word)))) {
      ++english;
    }
    if (begin == end && !known.is_word(word)) ++unknown;
  }
  const auto best =
      std::max_element(own.begin(), own.end(), [](const auto& left, const auto& right) {
        return left.second < right.second ||
               (left.second == right.second && std::string_view(left.first) > right.first);
      });
  // One word alone may be borrowed: "pas de deux".
  if (best != own.end() && best->second > english &&
      (best->second > 1 || listed + unknown == words)) {
    return best->first;
  }
  return words >= 2 && unknown == words ? kAnotherLanguage : "";
}

}  // namespace remomask::search
