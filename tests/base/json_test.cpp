#include "base/json.h"

#include <gtest/gtest.h>

namespace remomask {
namespace {

std::string nested(int depth) { return std::string(depth, '[') + std::string(depth, ']'); }

std::string reason_of(const std::string& text) {
  try {
    parse_json(text);
  } catch (const nlohmann::json::exception& error) {
    return json_reason(error);
  }
  return "";
}

TEST(Json, IsReadDownToTheDeepestLevel) {
  EXPECT_EQ(parse_json(nested(kMaxJsonDepth)).size(), 1u);
  EXPECT_EQ(reason_of(nested(kMaxJsonDepth + 1)), "it is nested deeper than 100 levels");
  EXPECT_TRUE(try_parse_json(nested(1000000)).is_discarded());
  EXPECT_EQ(reason_of(std::string(1000000, '{')), "it is nested deeper than 100 levels");
}

TEST(Json, ManySmallValuesDoNotFillTheMemory) {
  std::string text = "[0";
  for (int i = 0; i < 2100000; ++i) text += ",0";
  EXPECT_EQ(reason_of(text + "]"), "it holds more than two million values");
  EXPECT_TRUE(try_parse_json(text + "]").is_discarded());
  EXPECT_EQ(parse_json(text.substr(0, 2000002) + "]").size(), 1000001u);
}

TEST(Json, BracketsInTextsAreNoLevels) {
  const std::string text = "[\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"]";
  EXPECT_EQ(parse_json(text)[0].get<std::string>().size(), 2001u);
}

TEST(Json, ReasonsNameNoExceptionAndStayShort) {
  const std::string reason = reason_of("{\"a\": \"" + std::string(100000, 'x'));
  EXPECT_EQ(reason.find("json.exception"), std::string::npos) << reason;
  EXPECT_LT(reason.size(), 200u);
  EXPECT_EQ(try_parse_json("{} x").is_discarded(), true);
}

}  // namespace
}  // namespace remomask
