// JSON in and out: what is refused, with its message, and what survives.
#include "io/json.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using tests::read_text;
using tests::TempFolder;
using tests::write_text;

// The message of the IoError that work throws, which must be about the input.
template <typename Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const IoError& error) {
    EXPECT_EQ(error.side(), IoError::Side::kInput);
    return error.what();
  }
  return "no error";
}

// What read_json says of a text, without the name of the file.
std::string complaint(const std::string& text) {
  const TempFolder folder;
  const std::string file = (folder / "x.json").string();
  write_text(file, text);
  const std::string message = message_of([&] { read_json(file); });
  EXPECT_THAT(message, StartsWith(file + ": "));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
  return message.substr(file.size() + 2);
}

TEST(ReadJson, KeepsTheOrderOfKeys) {
  const TempFolder folder;
  write_text(folder / "x.json", R"({"z": 1, "a": {"y": [1, 2.5], "b": null}})");
  EXPECT_EQ(read_json(folder / "x.json").dump(), R"({"z":1,"a":{"y":[1,2.5],"b":null}})");
}

TEST(ReadJson, SyntaxErrorsNameLineAndColumn) {
  EXPECT_THAT(complaint("{\n  \"a\": 1,\n  b\n}"), StartsWith("no JSON: line 3, column 3: syntax error"));
  EXPECT_THAT(complaint(""), StartsWith("no JSON: line 1, column 1: "));
  EXPECT_THAT(complaint("{\"a\": [1, 2"), StartsWith("no JSON: line 1, column 12: "));
  EXPECT_THAT(complaint("{} {}"), StartsWith("no JSON: line 1, column 4: "));
  EXPECT_THAT(complaint("[NaN]"), StartsWith("no JSON: line 1, column 2: "));
  EXPECT_THAT(complaint("[\"\xff\x01\"]"), StartsWith("no JSON: line 1, column 3: "));
  EXPECT_THAT(complaint("[1e999]"), StartsWith("no JSON: number overflow parsing '1e999'"));
}

TEST(ReadJson, AKeyGivenTwiceIsRefusedWhereverItIs) {
  const std::string tail = " is there twice (expected every key once); remove one of them";
  EXPECT_EQ(complaint(R"({"a": 1, "a": 1})"), "'a'" + tail);
  EXPECT_EQ(complaint(R"({"a": {"b": {"c": 1}, "d": 2, "b": 3}})"), "'a.b'" + tail);
  EXPECT_EQ(complaint(R"({"l": [{"a": 1}, {"a": 1, "b": 2, "a": 3}]})"), "'l.a'" + tail);
  EXPECT_EQ(complaint(R"({"a": {"b": 1}, "c": {"b": 1}, "a": 2})"), "'a'" + tail);
}

TEST(ReadJson, TheSameKeyInDifferentObjectsIsFine) {
  const TempFolder folder;
  write_text(folder / "x.json", R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})");
  EXPECT_EQ(read_json(folder / "x.json")["b"][1]["a"], 2);
}

TEST(ReadJson, NestingWithoutEndIsRefused) {
  EXPECT_EQ(complaint(std::string(100000, '[')),
            "nested more than 64 levels deep (expected a flatter document)");
}

TEST(ReadJson, AFileTooLargeIsRefusedBeforeItIsRead) {
  const TempFolder folder;
  const auto file = folder / "x.json";
  write_text(file, "{}");
  std::filesystem::resize_file(file, (std::uintmax_t{64} << 20) + 1);
  EXPECT_EQ(
      message_of([&] { read_json(file); }),
      file.string() + ": 67108865 bytes (expected at most 67108864 bytes of JSON); is this the right file?");
}

TEST(ReadJson, WhatIsNoFileIsAnError) {
  const TempFolder folder;
  const auto file = folder / "none.json";
  EXPECT_EQ(message_of([&] { read_json(file); }),
            file.string() + ": no such file (expected a JSON file); check the name");
  EXPECT_EQ(message_of([&] { read_json(folder.path()); }),
            folder.path().string() + ": is a directory (expected a JSON file); name a file in it");
}

TEST(WriteJson, NumbersSurviveBitForBit) {
  const TempFolder folder;
  std::mt19937_64 random(11);
  Json numbers = Json::array();
  while (numbers.size() < 5000) {
    const auto number = std::bit_cast<double>(random());
    if (std::isfinite(number)) numbers.push_back(number);
  }
  for (const double number : {0.0, -0.0, 0.1, 1e-310, std::numeric_limits<double>::max()}) {
    numbers.push_back(number);
  }
  write_json(folder / "x.json", numbers);
  const Json back = read_json(folder / "x.json");
  ASSERT_EQ(back.size(), numbers.size());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back[k].get<double>()),
              std::bit_cast<std::uint64_t>(numbers[k].get<double>()));
  }
}

TEST(WriteJson, IsIndentedAndEndsWithANewline) {
  const TempFolder folder;
  write_json(folder / "x.json", {{"b", 1}, {"a", "two"}});
  EXPECT_EQ(read_text(folder / "x.json"), "{\n  \"b\": 1,\n  \"a\": \"two\"\n}\n");
}

TEST(WriteJson, NumbersThatAreNotFiniteAreRefusedAndNothingIsWritten) {
  const TempFolder folder;
  const Json json = {{"ok", 1.0}, {"list", {1.0, {{"x", std::numeric_limits<double>::quiet_NaN()}}}}};
  try {
    write_json(folder / "x.json", json);
    FAIL() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "write_json: 'list.1.x' is not finite");
  }
  EXPECT_THROW(write_json(folder / "x.json", -std::numeric_limits<double>::infinity()),
               std::invalid_argument);
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WriteJson, AnyBytesInAStringStillMakeJson) {
  const TempFolder folder;
  write_json(folder / "x.json", {{"name", "caf\xe9"}});  // a file name in Latin-1
  EXPECT_EQ(read_json(folder / "x.json")["name"], "caf\xef\xbf\xbd");
}

// One object with a member of every type.
class ObjectReaderTest : public testing::Test {
 protected:
  Json json_ = Json::parse(R"({"number": 2.5, "integer": 7, "string": "s", "strings": ["a", "b"],
                               "object": {"inner": 1}, "huge": 18446744073709551615, "true": true,
                               "mixed": ["a", 1], "null": null})");
  ObjectReader reader_{json_, "f.json", "root"};
};

TEST_F(ObjectReaderTest, GivesWhatIsThere) {
  EXPECT_EQ(reader_.number("number", 2.5, 2.5), 2.5);
  EXPECT_EQ(reader_.number("integer", 0, 10), 7.0);
  EXPECT_EQ(reader_.integer("integer", 7, 7), 7);
  EXPECT_EQ(reader_.string("string"), "s");
  EXPECT_THAT(reader_.strings("strings"), ElementsAre("a", "b"));
  EXPECT_EQ(reader_.object("object").integer("inner", 0, 1), 1);
  EXPECT_TRUE(reader_.member("null").is_null());
}

TEST_F(ObjectReaderTest, FallsBackOnlyWhereNothingIsThere) {
  EXPECT_EQ(reader_.number("none", 0, 1, 0.5), 0.5);
  EXPECT_EQ(reader_.integer("none", 0, 1, 1), 1);
  EXPECT_EQ(reader_.string("none", "x"), "x");
  EXPECT_EQ(reader_.number("number", 0, 5, 0.5), 2.5);
  EXPECT_EQ(reader_.integer("integer", 0, 10, 1), 7);
  EXPECT_EQ(reader_.string("string", "x"), "s");
  EXPECT_THROW(reader_.number("string", 0, 5, 0.5), IoError);
}

TEST_F(ObjectReaderTest, EveryComplaintNamesTheMember) {
  const auto complaint_of = [](const auto& work) { return message_of(work); };
  EXPECT_EQ(complaint_of([&] { reader_.number("none", 0, 1); }),
            "f.json: 'root.none' is missing (expected a number in [0, 1])");
  EXPECT_EQ(complaint_of([&] { reader_.number("number", 0, 1); }),
            "f.json: 'root.number' is 2.5 (expected a number in [0, 1])");
  EXPECT_EQ(complaint_of([&] { reader_.number("true", 0, 1); }),
            "f.json: 'root.true' is true (expected a number in [0, 1])");
  EXPECT_EQ(complaint_of([&] { reader_.integer("number", 0, 9); }),
            "f.json: 'root.number' is 2.5 (expected an integer in [0, 9])");
  EXPECT_EQ(complaint_of([&] { reader_.integer("integer", 8, 9); }),
            "f.json: 'root.integer' is 7 (expected an integer in [8, 9])");
  EXPECT_EQ(complaint_of([&] { reader_.integer("huge", -9, 9); }),
            "f.json: 'root.huge' is 18446744073709551615 (expected an integer in [-9, 9])");
  EXPECT_EQ(complaint_of([&] { reader_.string("object"); }),
            "f.json: 'root.object' is an object (expected a string)");
  EXPECT_EQ(complaint_of([&] { reader_.strings("mixed"); }),
            "f.json: 'root.mixed' holds more than strings (expected an array of strings)");
  EXPECT_EQ(complaint_of([&] { reader_.object("strings"); }),
            "f.json: 'root.strings' is an array (expected an object)");
  EXPECT_EQ(complaint_of([&] { reader_.object("none"); }),
            "f.json: 'root.none' is missing (expected an object)");
  EXPECT_EQ(complaint_of([&] { reader_.object("object").number("x", 0, 1); }),
            "f.json: 'root.object.x' is missing (expected a number in [0, 1])");
  EXPECT_EQ(complaint_of([&] { ObjectReader(Json(3), "f.json"); }),
            "f.json: the document is 3 (expected an object)");
}

TEST_F(ObjectReaderTest, FinishRefusesWhatWasNeverAskedFor) {
  const Json json = {{"known", 1}, {"optional", 2}, {"misspelt", 3}};
  ObjectReader reader(json, "f.json");
  reader.integer("known", 0, 9);
  reader.integer("optional", 0, 9, 5);
  EXPECT_EQ(message_of([&] { reader.finish(); }),
            "f.json: 'misspelt' is unknown (expected only known, optional)");
  reader.member("misspelt");
  EXPECT_NO_THROW(reader.finish());
}

}  // namespace
}  // namespace brdfit::io
