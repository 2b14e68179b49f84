#include "rig/name_words.h"

#include <algorithm>
#include <unordered_map>

namespace remomask::rig {

namespace {

std::unordered_map<std::string_view, Word> make_dictionary() {
  std::unordered_map<std::string_view, Word> words;
  const auto add = [&](const Word& word, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) words[name] = word;
  };
  const auto add_part = [&](BodyPart part, std::initializer_list<std::string_view> names) {
    add({WordKind::part, part, Side::none}, names);
  };
  const auto add_kind = [&](WordKind kind, std::initializer_list<std::string_view> names) {
    add({kind, BodyPart::none, Side::none}, names);
  };
  add({WordKind::side, BodyPart::none, Side::left}, {"left", "l", "lft", "lt", "lf"});
  add({WordKind::side, BodyPart::none, Side::right}, {"right", "r", "rgt", "rt"});

  add_part(BodyPart::root, {"root", "center", "centre", "cog", "hub"});
  add_part(BodyPart::pelvis, {"pelvis", "hips", "sacrum", "lowerbody", "lowertorso"});
  add_part(BodyPart::hip, {"hip"});
  add_part(BodyPart::spine,
           {"spine",     "chest",     "upperchest", "abdomen", "abdominal", "ab",       "abs",
            "torso",     "waist",     "back",       "thorax",  "belly",     "stomach",  "trunk",
            "sternum",   "rib",       "ribs",       "ribcage", "lumbar",    "thoracic", "upperbody",
            "upperback", "lowerback", "navel",      "body",    "backbone"});
  add_part(BodyPart::neck, {"neck", "cervical"});
  add_part(BodyPart::head, {"head", "skull", "cranium"});
  add_part(BodyPart::thigh, {"thigh", "femur", "upleg", "upperleg"});
  add_part(BodyPart::leg, {"leg"});
  add_part(BodyPart::shin, {"shin", "calf", "tibia", "fibula", "knee", "lowerleg", "lowleg"});
  add_part(BodyPart::ankle, {"ankle"});
  add_part(BodyPart::foot, {"foot", "feet"});
  add_part(BodyPart::heel, {"heel"});
  add_part(BodyPart::toe,
           {"toe", "toes", "toebase", "ball", "metatarsal", "metatarsals", "forefoot", "bigtoe"});
  add_part(BodyPart::collar, {"clavicle", "clav", "collar", "collarbone", "scapula"});
  add_part(BodyPart::shoulder, {"shoulder", "shldr"});
  add_part(BodyPart::upper_arm, {"upperarm", "uparm", "humerus"});
  add_part(BodyPart::arm, {"arm"});
  add_part(BodyPart::forearm, {"forearm", "lowerarm", "lowarm", "elbow", "radius", "ulna"});
  add_part(BodyPart::wrist, {"wrist"});
  add_part(BodyPart::hand, {"hand", "palm"});

  add_kind(WordKind::upper, {"upper", "up"});
  add_kind(WordKind::lower, {"lower", "low", "down", "dn"});
  add_kind(WordKind::fore, {"fore"});
  add_kind(WordKind::connector, {"buttock", "hipjoint"});
  add_kind(WordKind::tail, {"tail"});
  add_kind(WordKind::end, {"end", "nub", "tip", "top", "site", "effector", "ee", "endsite"});
  // Said of true joints as well, or by no means of a joint alone.
  add_kind(
      WordKind::filler,
      {"base",  "joint", "jnt",       "bone", "bend",      "def",      "org",      "bip",
       "biped", "b",     "j",         "c",    "m",         "mid",      "rig",      "joints",
       "avg",   "blade", "mixamorig", "rear", "character", "armature", "skeleton", "valvebiped",
       "cc",    "sk",    "skin",      "anim", "mixamo"});
  add_kind(WordKind::helper,
           {"twist",       "roll",       "ik",      "fk",       "ctrl",     "control", "controller",
            "pole",        "target",     "helper",  "aux",      "finger",   "fingers", "thumb",
            "index",       "middle",     "ring",    "pinky",    "pinkie",   "little",  "metacarpal",
            "metacarpals", "carpal",     "knuckle", "eye",      "eyes",     "eyelid",  "eyebrow",
            "eyelash",     "brow",       "lid",     "jaw",      "chin",     "teeth",   "tooth",
            "tongue",      "lip",        "lips",    "cheek",    "nose",     "nostril", "ear",
            "ears",        "face",       "facial",  "forehead", "lash",     "mouth",   "hair",
            "ponytail",    "bangs",      "skirt",   "cloth",    "cape",     "coat",    "belt",
            "strap",       "hat",        "helmet",  "prop",     "weapon",   "sword",   "gun",
            "shield",      "bag",        "breast",  "breasts",  "bust",     "boob",    "glute",
            "pec",         "pectoral",   "muscle",  "bicep",    "biceps",   "wing",    "socket",
            "attach",      "attachment", "camera",  "light",    "mesh",     "geo",     "corrective",
            "mch",         "sec",        "dress",   "scarf",    "share",    "volume",  "squash",
            "stretch",     "tweak",      "marker",  "genital",  "genitals", "wheel",   "handle"});
  return words;
}

}  // namespace

Word look_up_word(std::string_view word) {
  static const std::unordered_map<std::string_view, Word> dictionary = make_dictionary();
  const auto found = dictionary.find(word);
  if (found != dictionary.end()) return found->second;
  return {};
}

const std::vector<std::pair<std::string, std::string>>& east_asian_words() {
  static const std::vector<std::pair<std::string, std::string>> words = [] {
    std::vector<std::pair<std::string, std::string>> list = {
        {"左", "left"},       {"右", "right"},     {"センター", "root"}, {"下半身", "lowerbody"},
        {"上半身", "spine"},  {"骨盤", "pelvis"},  {"腰", "pelvis"},     {"臀部", "hip"},
        {"背骨", "spine"},    {"脊椎", "spine"},   {"脊柱", "spine"},    {"胸", "chest"},
        {"首", "neck"},       {"颈", "neck"},      {"脖子", "neck"},     {"頭", "head"},
        {"头", "head"},       {"肩", "shoulder"},  {"肩膀", "shoulder"}, {"锁骨", "clavicle"},
        {"鎖骨", "clavicle"}, {"腕", "arm"},       {"手臂", "arm"},      {"上臂", "upperarm"},
        {"上腕", "upperarm"}, {"前臂", "forearm"}, {"前腕", "forearm"},  {"ひじ", "elbow"},
        {"肘", "elbow"},      {"手首", "wrist"},   {"手腕", "wrist"},    {"手", "hand"},
        {"足", "leg"},        {"腿", "leg"},       {"太腿", "thigh"},    {"太もも", "thigh"},
        {"大腿", "thigh"},    {"ひざ", "knee"},    {"膝", "knee"},       {"膝盖", "knee"},
        {"小腿", "shin"},     {"すね", "shin"},    {"足首", "ankle"},    {"脚踝", "ankle"},
        {"脚", "foot"},       {"つま先", "toe"},   {"爪先", "toe"},      {"脚趾", "toe"},
        {"指", "finger"},     {"目", "eye"},       {"捩", "twist"},      {"捩り", "twist"},
        {"ＩＫ", "ik"},       {"先", "end"},       {"髪", "hair"},       {"スカート", "skirt"}};
    std::stable_sort(list.begin(), list.end(),
                     [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
    return list;
  }();
  return words;
}

}  // namespace remomask::rig
