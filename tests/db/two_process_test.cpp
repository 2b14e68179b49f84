#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "db/check.h"
#include "db/database.h"
#include "db/transaction.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

using Clock = std::chrono::steady_clock;

/// REMOMASK_SOAK_SECONDS makes it longer.
double test_seconds() {
  const char* chosen = std::getenv("REMOMASK_SOAK_SECONDS");
  return chosen ? std::atof(chosen) : 2;
}

void require(bool holds, const std::string& what) {
  if (!holds) throw Error(what);
}

// Every commit of the writer keeps: all clips are embedded, and each has the
// word "one" in exactly one of its two captions.
void write_until(const std::string& path, Clock::time_point end) {
  db::Database database(path, db::OpenMode::read_write);
  for (int n = 0; Clock::now() < end; ++n) {
    db::Transaction transaction(database);
    db::Clip clip = named_clip("clip " + std::to_string(n));
    clip.captions = {"one walk", "nothing"};
    const int64_t id = database.add_clip(clip, walking_motion(20 + n % 50, n));
    database.add_embeddings("r", {{id, {1.f}, {1.f}, {1.f}}});
    const auto ids = database.embedded_clips("r");
    if (n % 3 == 0) {
      db::ClipChanges changes;
      changes.captions = {"nothing", "one " + std::to_string(n)};
      changes.tags = {"t" + std::to_string(n % 5)};
      const int64_t changed = ids[static_cast<size_t>(n) % ids.size()];
      database.update_clip(changed, changes);
      database.add_embeddings("r", {{changed, {1.f}, {1.f}, {1.f}}});
    }
    if (ids.size() > 40) database.remove({ids[0], ids[ids.size() / 2]});
    transaction.commit();
  }
}

/// Returns how many different states were seen.
int read_until(const std::string& path, Clock::time_point end) {
  const db::Database database(path, db::OpenMode::read_only);
  int64_t last = -1;
  int states = 0;
  while (Clock::now() < end) {
    const db::ReadSnapshot snapshot(database);
    const int64_t generation = database.generation();
    require(generation >= last, "the generation went back");
    states += generation > last ? 1 : 0;
    last = generation;
    const auto clips = database.clips();
    std::vector<int64_t> ids;
    for (const db::Clip& clip : clips) {
      require(clip.captions.size() == 2, "captions are missing");
      require(database.motion(clip.id).frames == clip.frames, "another motion");
      ids.push_back(clip.id);
    }
    require(database.embedded_clips("r") == ids, "clips and vectors are of two states");
    std::vector<int64_t> worded;
    for (const db::CaptionMatch& match : database.match_captions("one"))
      worded.push_back(match.clip_id);
    std::sort(worded.begin(), worded.end());
    require(worded == ids, "clips and words are of two states");
    require(database.generation() == generation, "the state changed within a snapshot");
  }
  return states;
}

template <typename Work>
pid_t in_another_process(Work work) {
  const pid_t child = fork();
  if (child != 0) return child;
  try {
    work();
    _exit(0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "process %d: %s\n", static_cast<int>(getpid()), error.what());
    _exit(1);
  }
}

TEST(TwoProcesses, OneWriterAndThreeReadersSeeWholeStates) {
  TestFolder folder;
  const std::string path = folder / "d";
  { db::Database database(path, db::OpenMode::create); }
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(test_seconds()));
  std::vector<pid_t> children;
  children.push_back(in_another_process([&] { write_until(path, end); }));
  for (int reader = 0; reader < 3; ++reader) {
    children.push_back(in_another_process(
        [&] { require(read_until(path, end) > 2, "the writer was never seen to write"); }));
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  const db::CheckReport report = db::check_database(path);
  EXPECT_TRUE(report.defects.empty());
  const db::Database database(path, db::OpenMode::read_only);
  EXPECT_GT(database.generation(), 10);
}

}  // namespace
}  // namespace remomask
