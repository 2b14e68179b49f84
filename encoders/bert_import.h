#pragma once

#include <optional>
#include <string>

#include "nn/model_file.h"

namespace remomask::encoders {

struct BertImportOptions {
  /// Longer texts are cut; default: what the folder says, 256 if it does not.
  std::optional<int64_t> max_tokens;
  /// Name of the licence; default: what the weights' metadata say, "unknown" if they do not.
  std::string licence;
};

/// Reads an encoder of the BERT family in the layout in which they are published: config.json,
/// vocab.txt, model.safetensors or model_f16.safetensors (float32, float16 or bfloat16), and if
/// they are there 1_Pooling/config.json, modules.json, tokenizer_config.json,
/// sentence_bert_config.json. Returns the stage "text-encoder", whose config holds the vocabulary
/// and the licence too. Throws FileError for what is missing, damaged or not computed here, with
/// the file and the tensor or key.
nn::ModelStage import_bert(const std::string& folder, const BertImportOptions& options = {});

}  // namespace remomask::encoders
