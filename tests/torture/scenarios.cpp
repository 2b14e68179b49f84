#include "tests/torture/scenarios.h"

namespace remomask {

namespace {

Words with_model(Words words) {
  for (const char* word :
       {"--db", "%/m.sqlite", "--model", "%/model.safetensors", "--steps", "2"}) {
    words.emplace_back(word);
  }
  return words;
}

Scenario converted(const char* name, const std::string& extension) {
  return {name, {}, {"convert", "%/first.npy", "@/converted" + extension}};
}

Scenario trained(const char* name, const char* stage) {
  return {name,
          {},
          {"train", stage, "--db", "%/m.sqlite", "--preset", "tiny", "--steps", "3", "-o", "@/run"},
          /*generates=*/true,
          /*clock_step=*/61};
}

Words copied(const std::string& from, const std::string& to) { return {"cp", from, to}; }

std::vector<Scenario> all_scenarios() {
  const Words mine = copied("%/d.sqlite", "@/d.sqlite");
  const Words snapshot = {"db", "snapshot", "@/d.sqlite", "@/s.sqlite"};
  const std::string formats = REMOMASK_SOURCE_DIR "/tests/data/formats/";
  const Words oldest = copied(formats + "database_1.sqlite", "@/old.sqlite");
  const Words last = copied(formats + "database_5.sqlite", "@/old.sqlite");
  const Words generate = with_model({"generate", "a person walks", "--seconds", "2", "-n", "2",
                                     "--sheet", "@/sheet.png", "-o", "@/walk.bvh", "--force"});
  Words generate_before = generate;
  generate_before.insert(generate_before.end(), {"--seed", "7"});
  return {
      {"import", {}, {"import", "%/files", "--db", "@/new.sqlite"}},
      {"procedural", {}, {"procedural", "--db", "@/new.sqlite", "--count", "4"}},
      {"index", {mine}, {"index", "@/d.sqlite"}},
      {"add", {}, {"db", "add", "@/e.sqlite", "%/first.npy", "--caption", "a person"}},
      {"tag", {mine}, {"db", "tag", "@/d.sqlite", "#1", "#2", "#4", "--add", "good"}},
      {"captions", {mine}, {"db", "tag", "@/d.sqlite", "#1", "#5", "--set-caption", "a man bows"}},
      {"attribute", {mine}, {"db", "attribute", "@/d.sqlite", "procedural", "made by formulas"}},
      {"remove", {mine}, {"db", "remove", "@/d.sqlite", "#2", "#3", "--yes"}},
      {"merge",
       {mine, {"procedural", "--db", "@/e.sqlite", "--count", "3"}},
       {"db", "merge", "@/e.sqlite", "@/d.sqlite"}},
      {"snapshot", {mine, snapshot}, {"db", "snapshot", "@/d.sqlite", "@/s.sqlite", "--force"}},
      {"restore", {mine, snapshot}, {"db", "restore", "@/s.sqlite", "@/r.sqlite", "--force"}},
      {"restore_over",
       {mine, snapshot, {"db", "remove", "@/d.sqlite", "#1", "--yes"}},
       {"db", "restore", "@/s.sqlite", "@/d.sqlite", "--force"}},
      {"upgrade_1", {oldest}, {"db", "upgrade", "@/old.sqlite"}},
      {"upgrade_5", {last}, {"db", "upgrade", "@/old.sqlite"}},
      {"write_old", {oldest}, {"db", "tag", "@/old.sqlite", "walk", "--add", "good"}},
      {"export", {}, {"db", "export", "%/d.sqlite", "@/files", "--resume"}},
      {"export_bvh", {}, {"db", "export", "%/d.sqlite", "@/files", "--format", "bvh", "--resume"}},
      converted("convert_bvh", ".bvh"),
      converted("convert_glb", ".glb"),
      converted("convert_vrma", ".vrma"),
      converted("convert_fbx", ".fbx"),
      converted("convert_npz", ".npz"),
      converted("convert_npy", ".npy"),
      {"retarget",
       {{"convert", "%/first.npy", "@/figure.glb"}},
       {"retarget", "%/first.npy", "--character", "@/figure.glb", "-o", "@/on_figure.glb"}},
      {"sheet", {}, {"sheet", "%/first.npy", "-o", "@/sheet.png"}},
      {"skeleton",
       {{"convert", "%/first.npy", "@/a.bvh"}},
       {"skeleton", "@/a.bvh", "--picture", "@/a.png", "--write-map", "@/a.json", "--force"}},
      {"import_text",
       {},
       {"import-text", REMOMASK_SOURCE_DIR "/tests/fuzz/corpus/encoder", "-o",
        "@/text.safetensors"}},
      {"generate", {generate_before}, generate, /*generates=*/true},
      {"generate_one_file",
       {},
       with_model({"generate", "a person walks", "--seconds", "2", "-n", "2", "--one-file", "-o",
                   "@/walk.glb", "--force"}),
       /*generates=*/true},
      {"script",
       {copied(REMOMASK_SOURCE_DIR "/tests/fuzz/corpus/script/comments.txt", "@/script.txt")},
       with_model({"generate", "--script", "@/script.txt", "-o", "@/script.npy", "--force"}),
       /*generates=*/true},
      {"edit",
       {},
       with_model({"edit", "%/first.npy", "--prompt", "a person waves", "--span", "0.5-1",
                   "--sheet", "@/edit.png", "-o", "@/edited.npy", "--force"}),
       /*generates=*/true},
      trained("train_retriever", "retriever"),
      trained("train_tokenizer", "tokenizer"),
      trained("train_all", "all"),
      trained("train_evaluator", "evaluator"),
  };
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = all_scenarios();
  return all;
}

Words in_folders(const Words& words, const std::string& folder, const std::string& shared) {
  Words result;
  for (const std::string& word : words) {
    if (word.starts_with("@")) {
      result.push_back(folder + word.substr(1));
    } else if (word.starts_with("%")) {
      result.push_back(shared + word.substr(1));
    } else {
      result.push_back(word);
    }
  }
  return result;
}

}  // namespace remomask
