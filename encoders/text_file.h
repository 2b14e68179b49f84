#pragma once

#include <string>

namespace remomask::encoders {

/// Where the sentence encoder of a model is: "text.safetensors" beside the model file, or beside
/// the stage files of a training, if there is one; else the shipped one.
std::string text_file_of(const std::string& model_path);

}  // namespace remomask::encoders
