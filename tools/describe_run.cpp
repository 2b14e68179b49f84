#include <fmt/format.h>

#include "base/counted.h"
#include "db/transaction.h"
#include "retriever/retriever.h"
#include "search/describe.h"
#include "tools/describe_command.h"
#include "tools/generation_run.h"

namespace remomask::tools {

void run_describe(const DescribeCommand& command, Program& program) {
  const retriever::Retriever retriever =
      retriever::open_retriever(command.files.model_path(), text_file(command.files));
  db::Database database(command.files.database_path(), db::OpenMode::read_write);
  search::DescribeOptions options;
  options.min_probability = command.min_probability;
  options.captions = static_cast<size_t>(command.captions);
  const search::Descriptions made =
      search::describe_clips(database, retriever.hash(), retriever.words()->hash(), command.clips,
                             options, program.monitor());
  db::Transaction transaction(database);
  database.remove_guesses(command.clips);
  database.store_guesses(made.guesses);
  transaction.commit();
  program.finish_progress();
  nlohmann::json described = nlohmann::json::array();
  for (const db::GuessedCaption& guess : made.guesses) {
    const std::string name = database.clip(guess.clip_id).name;
    if (described.empty() || described.back().at("clip") != name) {
      described.push_back({{"clip", name}, {"captions", nlohmann::json::array()}});
    }
    described.back()["captions"].push_back(
        {{"text", guess.text}, {"probability", guess.probability}});
    if (!program.json)
      fmt::print("{:<32} {:3.0f} %  {}\n", name, 100 * guess.probability, guess.text);
  }
  if (program.json) {
    return program.print_json({{"described", described},
                               {"undescribed", made.undescribed},
                               {"learnt_from", made.learnt_from},
                               {"share_right", made.share_right}});
  }
  fmt::print(
      "{} of {} described, by guess; of {} with captions the first guess is right for {:.0f} %\n",
      described.size(), counted(static_cast<int64_t>(command.clips.size()), "clip"),
      made.learnt_from, 100 * made.share_right);
}

}  // namespace remomask::tools
