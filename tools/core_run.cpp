#include "nn/threads.h"
#include "tools/ablate_command.h"
#include "tools/check_command.h"
#include "tools/core.h"
#include "tools/describe_command.h"
#include "tools/edit_command.h"
#include "tools/evaluate_command.h"
#include "tools/generate_command.h"
#include "tools/import_text_command.h"
#include "tools/index_command.h"
#include "tools/search_command.h"
#include "tools/train_command.h"

namespace remomask::tools {

extern "C" __attribute__((visibility("default"))) const Core* remomask_core(int threads) {
  static constexpr Core commands = {
      .ablate = run_ablate,
      .check_file = check_core_file,
      .describe = run_describe,
      .edit = run_edit,
      .evaluate_calibration = run_evaluate_calibration,
      .evaluate_evaluator = run_evaluate_evaluator,
      .evaluate_generation = run_evaluate_generation,
      .evaluate_moments = run_evaluate_moments,
      .evaluate_queries = run_evaluate_queries,
      .evaluate_retrieval = run_evaluate_retrieval,
      .evaluate_search = run_evaluate_search,
      .evaluate_tokenizer = run_evaluate_tokenizer,
      .generate = run_generate,
      .import_text = run_import_text,
      .index = run_index,
      .model_info = run_model_info,
      .search = run_search,
      .train = run_train,
  };
  nn::set_compute_threads(threads);
  return &commands;
}

}  // namespace remomask::tools
