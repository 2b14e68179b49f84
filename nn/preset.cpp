#include "nn/preset.h"

#include "remomask/error.h"

namespace remomask::nn {

const std::vector<Preset>& all_presets() {
  static const std::vector<Preset> presets = {
      {Size::tiny},   {Size::small},      {Size::base},        {Size::paper},
      {Size::momask}, {Size::tiny, true}, {Size::small, true}, {Size::base, true}};
  return presets;
}

std::string size_name(Size size) {
  switch (size) {
    case Size::tiny:
      return "tiny";
    case Size::small:
      return "small";
    case Size::base:
      return "base";
    case Size::paper:
      return "paper";
    case Size::momask:
      return "momask";
  }
  return "";
}

std::string preset_name(const Preset& preset) {
  return (preset.one_row ? "momask-" : "") + size_name(preset.size);
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : all_presets()) names.push_back(preset_name(preset));
  return names;
}

Preset parse_preset(const std::string& name) {
  std::string known;
  for (const Preset& preset : all_presets()) {
    if (preset_name(preset) == name) return preset;
    known += (known.empty() ? "" : ", ") + preset_name(preset);
  }
  throw Error("there is no preset \"" + name + "\"; use one of " + known);
}

}  // namespace remomask::nn
