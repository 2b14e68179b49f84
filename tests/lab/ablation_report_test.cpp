#include "lab/ablation_report.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remomask {
namespace {

nlohmann::json exam_figures(double right, double fid) {
  nlohmann::json figures = lab::ExamFigures();
  figures["prompts"] = 10;
  figures["content_right"] = right;
  figures["metrics"]["fid"]["mean"] = fid;
  return {{"all", figures}};
}

nlohmann::json two_variants() {
  nlohmann::json document = {{"preset", "tiny"},
                             {"seeds", {1, 2}},
                             {"stages", {{"masked", {{"steps", 60}, {"batch", 16}}}}},
                             {"prompts", 10},
                             {"split", "test"},
                             {"real", exam_figures(0.9, 0)}};
  const auto variant = [](const std::string& name, double first, double second) {
    nlohmann::json result = {{"name", name}, {"meaning", "meaning of " + name}, {"weights", 1.5e6}};
    result["seeds"][0]["figures"] = exam_figures(first, 2);
    result["seeds"][1]["figures"] = exam_figures(second, std::nan(""));
    return result;
  };
  document["variants"][0] = variant("full", 0.5, 0.7);
  document["variants"][1] = variant("no-ssta", 0.25, 0.25);
  document["sweeps"] = {{"guidance", nlohmann::json::array()}, {"steps", nlohmann::json::array()}};
  // As it is read back: what is not a number is null.
  return nlohmann::json::parse(document.dump());
}

TEST(AblationReport, SeedsBecomeMeanAndRange) {
  const auto document = two_variants();
  const auto& full = document["variants"][0];
  EXPECT_EQ(lab::seed_values(full, "all", "/content_right"), (std::vector<double>{0.5, 0.7}));
  EXPECT_EQ(lab::seed_values(full, "all", "/metrics/fid/mean"), (std::vector<double>{2}));
  EXPECT_TRUE(lab::seed_values(full, "take", "/content_right").empty());
  const std::string text = lab::ablation_markdown(document);
  EXPECT_NE(text.find("| full | meaning of full | 1.5 M | 60.0 (50.0-70.0) | "), std::string::npos)
      << text;
  EXPECT_NE(text.find("| no-ssta | meaning of no-ssta | 1.5 M | 25.0 (25.0-25.0) | "),
            std::string::npos);
  EXPECT_NE(text.find("| real clips |  |  | 90.0 | "), std::string::npos);
  EXPECT_NE(text.find("masked 60 x 16"), std::string::npos);
  EXPECT_NE(text.find("2 seeds, mean (min-max)"), std::string::npos);
  EXPECT_EQ(text.find("guidance"), std::string::npos);
}

TEST(AblationReport, SubsetsAndSweepsHaveTablesOfTheirOwn) {
  auto document = two_variants();
  document["real"]["rare"] = document["real"]["all"];
  document["variants"][0]["seeds"][0]["figures"]["rare"] = exam_figures(0.125, 1)["all"];
  document["sweeps"]["steps"][0] = {{"value", 5}, {"figures", exam_figures(0.75, 3)}};
  const std::string text = lab::ablation_markdown(document);
  EXPECT_NE(text.find("rare (10): content right, %"), std::string::npos) << text;
  EXPECT_NE(text.find("| full | 12.5 | 0.0 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| no-ssta | - | - |"), std::string::npos) << text;
  EXPECT_NE(text.find("another number of steps"), std::string::npos);
  EXPECT_NE(text.find("| 5 | 75.0 | "), std::string::npos) << text;
}

}  // namespace
}  // namespace remomask
