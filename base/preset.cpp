#include "base/preset.h"

#include "remomask/error.h"

namespace remomask {

const std::vector<Preset>& all_presets() {
  static const std::vector<Preset> presets = {{ModelSize::tiny},        {ModelSize::small},
                                              {ModelSize::base},        {ModelSize::paper},
                                              {ModelSize::momask},      {ModelSize::tiny, true},
                                              {ModelSize::small, true}, {ModelSize::base, true}};
  return presets;
}

std::string size_name(ModelSize size) {
  switch (size) {
    case ModelSize::tiny:
      return "tiny";
    case ModelSize::small:
      return "small";
    case ModelSize::base:
      return "base";
    case ModelSize::paper:
      return "paper";
    case ModelSize::momask:
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

}  // namespace remomask
