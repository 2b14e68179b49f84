#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "remomask/export.h"

namespace remomask {

/// What long work tells its caller. Libraries never print: the program turns
/// this into a bar or plain lines.
struct REMOMASK_API Progress {
  std::string stage;   ///< for example "import bandai2" or "train tokenizer"
  double done = 0;     ///< in units of `total`
  double total = 0;    ///< 0 when unknown
  std::string detail;  ///< figures of the moment, for example "loss 0.41"
};

using ProgressFunction = std::function<void(const Progress&)>;

/// How long work is observed and stopped.
struct REMOMASK_API Monitor {
  ProgressFunction progress;  ///< may be empty
  std::stop_token stop;       ///< checked often; work stops in a resumable state

  void report(const Progress& value) const {
    if (progress) progress(value);
  }
  bool stop_requested() const { return stop.stop_requested(); }
};

}  // namespace remomask
