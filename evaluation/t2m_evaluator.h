#pragma once

#include <string>

#include "nn/model_file.h"
#include "nn/safetensors.h"

namespace remomask::evaluation {

/// The evaluator of Guo et al. (text_mot_match/model/finest.tar) as a safetensors
/// file: tensors movement_encoder.*, motion_encoder.*, text_encoder.* under the
/// names of the checkpoint, `mean` and `std` of its meta folder [263 or 251],
/// `word_vectors` [V, 300] (GloVe), and the V words as a JSON list under
/// "vocabulary" in the metadata, the first three being sos, eos, unk.
bool is_t2m_evaluator(const nn::TensorFile& file);

/// Stage "evaluator" of preset "paper" in official features. Throws FileError
/// when something lacks; shapes are checked when the Evaluator is built. Word
/// classes are ours (see word_classes.h): the published figures came from a
/// tagger's.
nn::ModelStage import_t2m_evaluator(const nn::TensorFile& file, const std::string& path);

}  // namespace remomask::evaluation
