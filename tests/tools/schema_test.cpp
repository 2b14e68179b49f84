// The answers of the program are what the schemas of docs/schema say.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

using Json = nlohmann::json;

Json schema_file(const std::string& name) {
  return Json::parse(read_file(std::string(REMOMASK_SOURCE_DIR) + "/docs/schema/" + name));
}

bool has_type(const Json& value, const std::string& type) {
  return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
         (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
         (type == "null" && value.is_null()) || (type == "number" && value.is_number()) ||
         (type == "integer" && value.is_number_integer());
}

/// What of JSON Schema 2020-12 the files of docs/schema use; members that a schema does not name
/// are refused, so that none is forgotten there. Returns what is wrong, or nothing.
std::string find_fault(const Json& schema, const Json& value, const std::string& place) {
  if (schema.contains("$ref")) return find_fault(schema_file(schema["$ref"]), value, place);
  if (schema.contains("const") && value != schema["const"]) return place + ": another constant";
  if (schema.contains("enum") &&
      std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end()) {
    return place + ": " + value.dump() + " is not listed";
  }
  if (schema.contains("anyOf")) {
    std::string fault;
    for (const Json& one : schema["anyOf"]) {
      fault = find_fault(one, value, place);
      if (fault.empty()) return "";
    }
    return fault;
  }
  if (schema.contains("type")) {
    const Json& type = schema["type"];
    const Json types = type.is_array() ? type : Json::array({type});
    if (std::none_of(types.begin(), types.end(),
                     [&](const Json& name) { return has_type(value, name); })) {
      return place + ": " + value.dump().substr(0, 40) + " is not of type " + type.dump();
    }
  }
  if (value.is_array() && schema.contains("items")) {
    for (size_t i = 0; i < value.size(); ++i) {
      const std::string fault =
          find_fault(schema["items"], value[i], place + "/" + std::to_string(i));
      if (!fault.empty()) return fault;
    }
  }
  if (!value.is_object() || !schema.contains("properties")) return "";
  for (const Json& name : schema.value("required", Json::array())) {
    if (!value.contains(name)) return place + ": " + name.dump() + " is missing";
  }
  for (const auto& [name, member] : value.items()) {
    if (!schema["properties"].contains(name)) return place + ": \"" + name + "\" is not described";
    const std::string fault = find_fault(schema["properties"][name], member, place + "/" + name);
    if (!fault.empty()) return fault;
  }
  return "";
}

std::string fault_of(const std::string& file, const Json& answer) {
  return find_fault(schema_file(file), answer, file);
}

TEST(Schema, TheCheckFindsFaults) {
  const Json schema = {
      {"type", "object"}, {"properties", {{"a", {{"type", "integer"}}}}}, {"required", {"a"}}};
  EXPECT_EQ(find_fault(schema, {{"a", 1}}, ""), "");
  EXPECT_NE(find_fault(schema, {{"a", "1"}}, ""), "");
  EXPECT_NE(find_fault(schema, Json::object(), ""), "");
  EXPECT_NE(find_fault(schema, {{"a", 1}, {"b", 2}}, ""), "");
}

TEST(Schema, DescribesMotions) {
  const TestFolder folder;
  const Json made = run_json({"generate", "a person walks forward", "--seconds", "2", "--best-of",
                              "2", "--influence", "-o", folder / "walk.npy"});
  EXPECT_EQ(fault_of("motions.json", made), "");
  EXPECT_EQ(fault_of("motion.json", Json::parse(read_file(folder / "walk.npy.json"))), "");
  EXPECT_EQ(fault_of("motions.json", run_json({"generate", "a person bows", "--length", "likely",
                                               "--no-retrieval", "-o", folder / "bow.npy"})),
            "");
  EXPECT_EQ(
      fault_of("motions.json", run_json({"edit", folder / "walk.npy", "--prompt", "someone waves",
                                         "--span", "0.5-1", "-o", folder / "edit.npy"})),
      "");
  write_file_atomically(folder / "script.txt", "2 a person walks\n2 someone waves\n");
  EXPECT_EQ(fault_of("motions.json", run_json({"generate", "--script", folder / "script.txt", "-o",
                                               folder / "script.npy"})),
            "");
}

TEST(Schema, DescribesDatabases) {
  const TestFolder folder;
  const std::string database = folder / "motions.sqlite";
  EXPECT_EQ(fault_of("procedural.json", run_json({"procedural", "--db", database, "--count", "12",
                                                  "--seed", "18446744073709551615"})),
            "");
  EXPECT_EQ(fault_of("index.json", run_json({"index", database})), "");
  EXPECT_EQ(fault_of("database_info.json", run_json({"db", "info", database})), "");
  EXPECT_EQ(fault_of("database_info.json", run_json({"info", database})), "");
  EXPECT_EQ(fault_of("clips.json", run_json({"db", "list", database, "--limit", "2"})), "");
  EXPECT_EQ(fault_of("clips.json", run_json({"db", "show", database, "#1"})), "");
  EXPECT_EQ(fault_of("check.json", run_json({"db", "check", database})), "");
  EXPECT_EQ(fault_of("file_check.json", run_json({"check", database})), "");
  run_json({"db", "export", database, folder / "clips", "--format", "npy"});
  for (const auto& entry : std::filesystem::directory_iterator(folder / "clips")) {
    if (entry.path().extension() != ".npy") continue;
    const Json made = run_json({"convert", entry.path().string(), folder / "walk.bvh"});
    EXPECT_EQ(fault_of("convert.json", made), "");
    run_json({"convert", entry.path().string(), folder / "figure.glb"});
    EXPECT_EQ(
        fault_of("retarget.json", run_json({"retarget", entry.path().string(), "--character",
                                            folder / "figure.glb", "-o", folder / "moved.glb"})),
        "");
    break;
  }
}

TEST(Schema, DescribesModels) {
  const TestFolder folder;
  const std::string database = folder / "motions.sqlite";
  run_json({"procedural", "--db", database, "--count", "60"});
  const Json trained = run_json({"train", "evaluator", "--db", database, "--preset", "tiny",
                                 "--steps", "2", "--seed", "7", "-o", folder / "run"});
  EXPECT_EQ(fault_of("train.json", trained), "");
  const Json info = run_json({"info", trained.at("file")});
  EXPECT_EQ(fault_of("model_info.json", info), "");
  EXPECT_EQ(info.dump().find("\"seed\":7"), std::string::npos) << "seeds are strings";
}

TEST(Schema, DescribesErrors) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--json", "genrate"}, {"--json", "info", "absent.sqlite"}}) {
    EXPECT_EQ(fault_of("error.json", Json::parse(run_program(arguments).output)), "");
  }
}

TEST(Schema, DescribesGuesses) {
  const TestFolder folder;
  const std::string database = folder / "motions.sqlite";
  std::filesystem::copy_file(std::string(REMOMASK_SOURCE_DIR) + "/models/motions.sqlite", database);
  std::filesystem::permissions(database, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(fault_of("describe.json", run_json({"db", "describe", database})), "");
  EXPECT_EQ(fault_of("describe.json", run_json({"db", "describe", database, "--remove"})), "");
}

TEST(Schema, DescribesSearches) {
  EXPECT_EQ(fault_of("search.json", run_json({"search", "someone waves", "--moments"})), "");
  EXPECT_EQ(fault_of("search.json", run_json({"search", "una persona camina"})), "");
  EXPECT_EQ(
      fault_of("search.json", run_json({"search", "someone waves", "--min-similarity", "0.999"})),
      "");
}

}  // namespace
}  // namespace remomask
