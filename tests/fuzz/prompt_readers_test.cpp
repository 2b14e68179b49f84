// What is typed or listed as sentences to generate or to search.
#include "pipeline/script.h"
#include "search/sentence.h"
#include "tests/fuzz/fuzz_test_tools.h"

namespace remomask {
namespace {

using PromptReaderFuzz = ReaderFuzz;

TEST_F(PromptReaderFuzz, Scripts) {
  fuzz(corpus("script"), 40,
       [](const std::string& content) { parse_script(content, "script.txt"); });
}

TEST_F(PromptReaderFuzz, MinusWords) {
  fuzz(corpus("sentence"), 200,
       [](const std::string& content) { search::parse_sentence(content); });
}

}  // namespace
}  // namespace remomask
