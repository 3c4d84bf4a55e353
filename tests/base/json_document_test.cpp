#include "musclesim/base/json_document.h"

#include "log/log_fixture.h"

namespace musclesim {
namespace {

std::string refusal(const std::string& text) {
  return messageOf<BadFile>([&] { JsonDocument(text, "run.json"); });
}

TEST(JsonDocument, MalformedTextIsRefusedWithItsPlace) {
  EXPECT_TRUE(hasWords(refusal(""), {"run.json:1:1: ", "not valid JSON"}));
  EXPECT_TRUE(hasWords(refusal("{\"a\": 1,\n \"b\" 2}"), {"run.json:2:6: ", "not valid JSON"}));
  EXPECT_TRUE(hasWords(refusal("{\"a\": 1}}"), {"run.json:1:9: "}));
  EXPECT_TRUE(hasWords(refusal("{\"a\": 1e999}"), {"run.json:1:", "overflow"}));
  EXPECT_TRUE(hasWords(refusal("{\"a\": NaN}"), {"run.json:1:7: "}));
  EXPECT_TRUE(hasWords(refusal("{\"a\": \"\xFF\"}"), {"run.json:1:8: "}));
  EXPECT_TRUE(hasWords(refusal("{\n\"a\": 1"), {"run.json:2:7: ", "end of input"}));
  EXPECT_TRUE(hasWords(refusal("[1, 2]"), {"run.json:1:1: ", "must hold one JSON object"}));
}

TEST(JsonDocument, MembersGivenTwiceAreRefused) {
  EXPECT_TRUE(hasWords(refusal("{\"a\": 1,\n  \"a\": 2}"), {"run.json:2:3: ", "\"a\" is given twice"}));
  EXPECT_TRUE(hasWords(refusal("{\"a\": {\"b\": 1, \"b\": 2}}"), {"run.json:1:16: ", "\"b\" is given twice"}));
  EXPECT_NO_THROW(JsonDocument("{\"a\": [{\"b\": 1}, {\"b\": 2}], \"b\": {\"a\": 1}, \"c\": {\"a\": 1}}", "run.json"));
}

TEST(JsonDocument, DeepNestingIsRefused) {
  const std::string deep = "{\"a\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}";
  EXPECT_TRUE(hasWords(refusal(deep), {"run.json:1:", "nested deeper than the 64 levels"}));
}

TEST(JsonDocument, NamesThePlaceOfAMember) {
  const JsonDocument document("{\n  \"first\": 1,\n  \"sec\\\"ond\": {\"first\": 2}\n}", "run.json");
  EXPECT_EQ(messageOf<BadFile>([&] { document.refuse("first", "is odd"); }), "run.json:2:3: is odd");
  EXPECT_EQ(messageOf<BadFile>([&] { document.refuse("sec\"ond", "is odd"); }), "run.json:3:3: is odd");
  EXPECT_EQ(messageOf<BadFile>([&] { document.refuse("third", "is missing"); }), "run.json: is missing");
  EXPECT_EQ(document.find("third"), nullptr);
}

}  // namespace
}  // namespace musclesim
