#include "encoders/text_file.h"

#include <filesystem>

#include "remomask/library.h"

namespace remomask::encoders {

std::string text_file_of(const std::string& model_path) {
  const auto beside = std::filesystem::path(model_path).replace_filename("text.safetensors");
  return std::filesystem::exists(beside) ? beside.string() : shipped_file("text.safetensors");
}

}  // namespace remomask::encoders
