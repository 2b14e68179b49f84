#pragma once

#include <string>

#include "tools/program.h"

namespace remomask::tools {

struct AblateCommand;
struct CheckedFile;
struct DescribeCommand;
struct EditCommand;
struct EvaluateCalibrationCommand;
struct EvaluateEvaluatorCommand;
struct EvaluateGenerationCommand;
struct EvaluateMomentsCommand;
struct EvaluateQueriesCommand;
struct EvaluateRetrievalCommand;
struct EvaluateSearchCommand;
struct EvaluateTokenizerCommand;
struct GenerateCommand;
struct ImportTextCommand;
struct IndexCommand;
struct SearchCommand;
struct TrainCommand;

/// The commands that need the networks. They are in a shared object of their own, remomask-core,
/// which is loaded when one of them runs: libtorch takes a second to load, and --help, --version
/// and wrong usage need none of it.
struct Core {
  void (*ablate)(const AblateCommand&, Program&);
  CheckedFile (*check_file)(const std::string&);
  void (*describe)(const DescribeCommand&, Program&);
  void (*edit)(const EditCommand&, Program&);
  void (*evaluate_calibration)(const EvaluateCalibrationCommand&, Program&);
  void (*evaluate_evaluator)(const EvaluateEvaluatorCommand&, Program&);
  void (*evaluate_generation)(const EvaluateGenerationCommand&, Program&);
  void (*evaluate_moments)(const EvaluateMomentsCommand&, Program&);
  void (*evaluate_queries)(const EvaluateQueriesCommand&, Program&);
  void (*evaluate_retrieval)(const EvaluateRetrievalCommand&, Program&);
  void (*evaluate_search)(const EvaluateSearchCommand&, Program&);
  void (*evaluate_tokenizer)(const EvaluateTokenizerCommand&, Program&);
  void (*generate)(const GenerateCommand&, Program&);
  void (*import_text)(const ImportTextCommand&, Program&);
  void (*index)(const IndexCommand&, Program&);
  void (*model_info)(const std::string&, Program&);
  void (*search)(const SearchCommand&, Program&);
  void (*train)(const TrainCommand&, Program&);
};

void run_model_info(const std::string& path, Program& program);

/// Loads the core once, with the recommended settings in the environment, which OpenBLAS and
/// libgomp read while they are loaded. Throws Error if it cannot be loaded.
const Core& core(const Program& program);

/// The entry of the shared object: sets the number of threads and returns its commands.
extern "C" const Core* remomask_core(int threads);
using CoreEntry = const Core* (*)(int threads);

}  // namespace remomask::tools
