#include "musclesim/log/recording.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "log_fixture.h"

namespace musclesim {
namespace {

const std::string sidecar_with_scales =
    R"({"format": "musclesim-recording-1", "robot": "rig", "pressure_full_scale_kPa": 600, "command_full_scale_V": 10})";

bool hasNote(const Recording& recording, const std::string& words) {
  for (const auto& note : recording.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

/// Equal bits; any NaN equals any other.
bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

TEST(Recording, ReadsAFileInAnyColumnOrder) {
  const auto recording =
      parseCsv("# a comment, \"any\" text\nlength_0_mm,command_1,time_s,command_0\n200.5,0.1,0,1\n,0.2,0.01,0\nnan,0.3,0.02,0.5\n");
  EXPECT_EQ(recording.file, "run.csv");
  EXPECT_EQ(recording.info.robot, "rig");
  EXPECT_EQ(recording.muscleCount(), 2);
  EXPECT_EQ(recording.time_s, (std::vector<double>{0, 0.01, 0.02}));
  ASSERT_TRUE(recording.find("length_0_mm"));
  const auto& length = recording.find("length_0_mm")->values;
  EXPECT_EQ(length[0], 200.5);
  EXPECT_TRUE(std::isnan(length[1]) && std::isnan(length[2]));
  EXPECT_EQ(recording.find("command_0")->values, (std::vector<double>{1, 0, 0.5}));
  EXPECT_EQ(recording.find("pressure_0"), nullptr);
  EXPECT_TRUE(recording.notes.empty());
}

TEST(Recording, AcceptsByteOrderMarkWindowsLineEndsAndSpaces) {
  const auto recording = parseCsv("\xEF\xBB\xBFtime_s, command_0\r\n0, 0.25\r\n1 ,+0.5\r\n\r\n  \r\n");
  EXPECT_EQ(recording.time_s, (std::vector<double>{0, 1}));
  EXPECT_EQ(recording.find("command_0")->values, (std::vector<double>{0.25, 0.5}));
}

TEST(Recording, AcceptsALastLineWithoutLineEnd) {
  EXPECT_EQ(parseCsv("time_s,command_0\n0,0.25\n1,0.5").time_s.size(), 2u);
}

TEST(Recording, OwnQuantitiesOfARun) {
  const auto recording = parseCsv("time_s,command_0,target_x_mm,target_y_mm,target_z_mm,activity\n0,0.5,1,2,3,4\n");
  EXPECT_EQ(recording.find("target_y_mm")->values[0], 2);
  EXPECT_EQ(recording.find("activity")->values[0], 4);
}

// Full scale 600 kPa and 10 V; all numbers computed by hand.
TEST(Recording, ConvertsEveryUnit) {
  struct Case {
    const char* column;
    const char* written;
    const char* canonical;
    double value;
  };
  const std::vector<Case> cases = {{"command_0_kPa", "150", "command_0", 0.25},
                                   {"command_0_bar", "3", "command_0", 0.5},
                                   {"command_0_MPa", "0.45", "command_0", 0.75},
                                   {"command_0_V", "2.5", "command_0", 0.25},
                                   {"pressure_0_kPa", "-6", "pressure_0", -0.01},
                                   {"pressure_0_bar", "6.06", "pressure_0", 1.01},
                                   {"pressure_0_MPa", "0.12", "pressure_0", 0.2},
                                   {"length_0_m", "0.2005", "length_0_mm", 200.5},
                                   {"length_0_cm", "20.05", "length_0_mm", 200.5},
                                   {"length_0_mm", "200.5", "length_0_mm", 200.5},
                                   {"hand_x_m", "-0.25", "hand_x_mm", -250},
                                   {"hand_y_cm", "1.5", "hand_y_mm", 15},
                                   {"hand_z_mm", "7", "hand_z_mm", 7},
                                   {"angle_elbow_rad", "0.5", "angle_elbow_deg", 28.64788975654116},
                                   {"angle_wrist_deg", "-30", "angle_wrist_deg", -30},
                                   {"target_y_m", "0.1", "target_y_mm", 100},
                                   {"force_0_N", "12.5", "force_0_N", 12.5}};
  for (const auto& expected : cases) {
    const bool is_command = std::string(expected.column).starts_with("command");
    const std::string header = is_command ? "time_s," : "time_s,command_0,";
    const auto recording =
        parseCsv(header + expected.column + "\n0," + (is_command ? "" : "0,") + expected.written + "\n", sidecar_with_scales);
    ASSERT_TRUE(recording.find(expected.canonical)) << expected.column;
    EXPECT_DOUBLE_EQ(recording.find(expected.canonical)->values[0], expected.value) << expected.column;
    EXPECT_EQ(hasNote(recording, "converted from"), std::string(expected.column) != expected.canonical) << expected.column;
  }
}

TEST(Recording, FullScaleIsExactlyOne) {
  EXPECT_EQ(parseCsv("time_s,command_0_bar\n0,6\n", sidecar_with_scales).find("command_0")->values[0], 1.0);
  EXPECT_EQ(parseCsv("time_s,command_0_V\n0,10\n", sidecar_with_scales).find("command_0")->values[0], 1.0);
}

TEST(Recording, CommandsWithinRoundingAreClamped) {
  const auto recording = parseCsv("time_s,command_0\n0,1.0000000009\n1,-0.0000000009\n");
  EXPECT_EQ(recording.find("command_0")->values, (std::vector<double>{1, 0}));
}

TEST(Recording, NotesOfConversionsOddPressuresAndEmptyColumns) {
  const auto recording = parseCsv("time_s,command_0_bar,pressure_0,length_0_m\n0,1,250,\n1,2,300,\n", sidecar_with_scales);
  EXPECT_TRUE(hasNote(recording, "converted from bar to fractions of 600 kPa: command_0_bar"));
  EXPECT_TRUE(hasNote(recording, "converted from m to mm: length_0_m"));
  EXPECT_TRUE(hasNote(recording, "pressure_0 reaches 250 of full scale"));
  EXPECT_TRUE(hasNote(recording, "length_0_mm has no value"));
}

TEST(Recording, IgnoredColumnsAreSkippedWhateverTheyHold) {
  const auto recording = parseCsv("time_s,command_0,remark,remark\n0,0.5,good,\n1,0.5,bad,inf\n", minimal_sidecar, {{"remark"}});
  EXPECT_EQ(recording.signals.size(), 1u);
  EXPECT_TRUE(hasNote(recording, "remark"));
}

struct Malformed {
  const char* name;
  std::string csv;
  int line, column;
  std::vector<std::string> words;
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
  *out << malformed.name;
}

class MalformedCsv : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedCsv, IsRefusedAtItsPlace) {
  const auto& malformed = GetParam();
  try {
    parseCsv(malformed.csv);
    FAIL() << "nothing was thrown";
  } catch (const BadFile& error) {
    EXPECT_EQ(error.file(), "run.csv");
    EXPECT_EQ(error.line(), malformed.line) << error.what();
    EXPECT_EQ(error.column(), malformed.column) << error.what();
    EXPECT_TRUE(hasWords(error.what(), malformed.words));
  }
}

const std::string two_rows = "time_s,command_0,length_0_mm\n0,0.5,200\n";

INSTANTIATE_TEST_SUITE_P(
    Recording, MalformedCsv,
    testing::Values(
        Malformed{"EmptyFile", "", 0, 0, {"run.csv: ", "no header row"}}, Malformed{"OnlyComments", "# a\n# b\n", 0, 0, {"no header row"}},
        Malformed{"BlankLineFirst", "\ntime_s,command_0\n0,0\n", 1, 1, {"empty line before the header"}},
        Malformed{"NoRows", "# a\ntime_s,command_0\n", 2, 0, {"no row", "at least one"}},
        Malformed{"NoTime", "# a\ncommand_0,length_0_mm\n0,1\n", 2, 1, {"no column time_s"}},
        Malformed{"NoCommand", "time_s,length_0_mm\n0,1\n", 1, 1, {"no column command_0"}},
        Malformed{"GapInCommands", "time_s,command_0,command_2\n0,0,0\n", 1, 1, {"no column command_1", "without gaps"}},
        Malformed{"MuscleWithoutCommand", "time_s,command_0,force_1_N\n0,0,0\n", 1, 1, {"force_1_N", "without command"}},
        Malformed{"DuplicateCommand", "time_s,command_0,command_0\n0,0,0\n", 1, 18, {"command_0", "given twice", "column 8"}},
        Malformed{"DuplicateInOtherUnit", "time_s,command_0,length_0_mm,length_0_m\n0,0,0,0\n", 1, 30, {"length_0_m", "given twice"}},
        Malformed{"DuplicateTime", "time_s,command_0,time_s\n0,0,0\n", 1, 18, {"time_s", "given twice"}},
        Malformed{"UnknownQuantity",
                  "time_s,command_0,velocity_0_mm\n0,0,0\n",
                  1,
                  18,
                  {"velocity_0_mm", "unknown quantity", "length_<i>_mm|cm|m"}},
        Malformed{"UnknownUnit", "time_s,command_0,length_0_inch\n0,0,0\n", 1, 18, {"length_0_inch", "unknown unit", "length_<i>_mm|cm|m"}},
        Malformed{"NamelessColumn", "time_s,command_0,\n0,0,0\n", 1, 18, {"no name", "allowed"}},
        Malformed{"PascalsWithoutFullScale", "time_s,command_0_kPa\n0,0\n", 1, 8, {"pressure_full_scale_kPa"}},
        Malformed{"VoltsWithoutFullScale", "time_s,command_0_V\n0,0\n", 1, 8, {"command_full_scale_V"}},
        Malformed{"QuotedHeader", "\"time_s\",\"command_0\"\n0,0\n", 1, 1, {"quoted", "without quotes"}},
        Malformed{"QuotedCell", two_rows + "1,\"0.5,200\n", 3, 3, {"quoted"}},
        Malformed{"Semicolons", "time_s;command_0\n0;0\n", 1, 7, {"commas", "semicolons"}},
        Malformed{"TooFewCells", two_rows + "1,0.5\n", 3, 3, {"2 cells", "line 1", "3 columns"}},
        Malformed{"TooManyCells", two_rows + "1,0.5,200,7\n", 3, 11, {"4 cells", "3 columns"}},
        Malformed{"DecimalCommas", two_rows + "1,0,5,200\n", 3, 7, {"4 cells"}},
        Malformed{"TextInACell", two_rows + "1,0.5,long\n", 3, 7, {"length_0_mm", "\"long\"", "not a number"}},
        Malformed{"TrailingText", two_rows + "1,0.5,200mm\n", 3, 7, {"\"200mm\"", "not a number"}},
        Malformed{"Infinity", two_rows + "1,0.5,inf\n", 3, 7, {"length_0_mm", "infinite"}},
        Malformed{"BeyondDouble", two_rows + "1,0.5,1e999\n", 3, 7, {"too large"}},
        Malformed{"BeyondDoubleAfterConversion", "time_s,command_0,length_0_m\n0,0,1e308\n", 2, 5, {"too large"}},
        Malformed{"TimeMissing", two_rows + ",0.5,200\n", 3, 1, {"time_s is not given"}},
        Malformed{"TimeNan", two_rows + "nan,0.5,200\n", 3, 1, {"time_s is not given"}},
        Malformed{"TimeRepeated", two_rows + "0,0.5,200\n", 3, 1, {"time_s = 0 s", "strictly increasing"}},
        Malformed{"TimeBackwards", two_rows + "-1,0.5,200\n", 3, 1, {"time_s = -1 s", "strictly increasing"}},
        Malformed{"CommandMissing", two_rows + "1,,200\n", 3, 3, {"command_0 is not given"}},
        Malformed{"CommandNan", two_rows + "1,nan,200\n", 3, 3, {"command_0 is not given"}},
        Malformed{"CommandTooLarge", two_rows + "1,1.1,200\n", 3, 3, {"command_0 = 1.1", "0 .. 1"}},
        Malformed{"CommandJustTooLarge", two_rows + "1,1.00000001,200\n", 3, 3, {"0 .. 1"}},
        Malformed{"CommandNegative", two_rows + "1,-0.1,200\n", 3, 3, {"command_0 = -0.1", "0 .. 1"}},
        Malformed{"NulByte", two_rows + std::string("1,0.\0", 5) + "5,200\n", 3, 5, {"NUL", "UTF-8"}},
        Malformed{"Utf16", std::string("\xFF\xFEt\0i\0", 6), 1, 4, {"NUL", "UTF-16"}},
        Malformed{"CommentAmongRows", two_rows + "# pause\n1,0.5,200\n", 3, 1, {"comment", "before the header"}},
        Malformed{"EmptyLineAmongRows", two_rows + "\n1,0.5,200\n", 3, 1, {"empty line"}},
        Malformed{"OldMacLineEnds", "time_s,command_0\r0,0\r1,0\r", 1, 17, {"carriage return"}},
        Malformed{"Binary",
                  "\x7F"
                  "ELF\x02\x01\n",
                  1,
                  1,
                  {"unknown quantity", "\\x7FELF"}}),
    [](const testing::TestParamInfo<Malformed>& info) { return info.param.name; });

TEST(Recording, ATornLastLineIsDroppedOnlyIfTheWriterDidNotFinish) {
  const std::string incomplete = R"({"format": "musclesim-recording-1", "robot": "rig", "complete": false})";
  for (const char* torn : {"1", "1,", "1,0.5,", "1,0.5,20", "1,0.5,2e", "n"}) {
    const auto recording = parseCsv(two_rows + torn, incomplete);
    EXPECT_EQ(recording.time_s.size(), 1u) << torn;
    EXPECT_TRUE(hasNote(recording, std::string("unfinished last line \"") + torn + "\"")) << torn;
  }
  EXPECT_EQ(parseCsv(two_rows + "1,0.5,200\n", incomplete).time_s.size(), 2u);
  EXPECT_THROW(parseCsv(two_rows + "1,0.5"), BadFile);
  EXPECT_THROW(parseCsv(two_rows + "1,0.5\n", incomplete), BadFile) << "a finished line is not a torn one";
}

TEST(Recording, SidecarPath) {
  EXPECT_EQ(sidecarPath("a/b.csv"), "a/b.json");
  EXPECT_EQ(sidecarPath("a.b/c"), "a.b/c.json");
}

Recording sample() {
  Recording recording;
  recording.info.robot = "rig";
  recording.info.seed = 7;
  recording.info.noise_std = {{"length_0_mm", 0.05}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  recording.signals = {{"command_0", {}}, {"pressure_0", {}}, {"length_0_mm", {}}, {"angle_elbow_deg", {}}};
  for (int i = 0; i < 2000; ++i) {
    recording.time_s.push_back(i * 0.01 + 1e-3 * uniform(random));
    recording.signals[0].values.push_back(uniform(random));
    recording.signals[1].values.push_back(i % 7 ? uniform(random) : std::nan(""));
    recording.signals[2].values.push_back(200 + 10 * std::sin(0.1 * i));
    // Any finite double, from random bits.
    double any = std::bit_cast<double>(random());
    recording.signals[3].values.push_back(std::isfinite(any) ? any : -0.0);
  }
  recording.signals[3].values[0] = std::numeric_limits<double>::denorm_min();
  recording.signals[3].values[1] = std::numeric_limits<double>::max();
  recording.signals[3].values[2] = -0.0;
  return recording;
}

TEST(Recording, WrittenAndReadAgainIsBitIdentical) {
  const TemporaryFolder folder;
  const auto written = sample();
  writeRecording(written, folder.file("run.csv"));
  EXPECT_EQ(folder.fileCount(), 2u) << "no temporary file is left";
  const auto read = readRecording(folder.file("run.csv"));
  EXPECT_EQ(read.file, folder.file("run.csv"));
  ASSERT_EQ(read.signals.size(), written.signals.size());
  ASSERT_EQ(read.time_s.size(), written.time_s.size());
  for (std::size_t row = 0; row < written.time_s.size(); ++row) {
    EXPECT_TRUE(sameBits(read.time_s[row], written.time_s[row]));
    for (std::size_t i = 0; i < written.signals.size(); ++i) {
      EXPECT_EQ(read.signals[i].name, written.signals[i].name);
      EXPECT_TRUE(sameBits(read.signals[i].values[row], written.signals[i].values[row])) << row;
    }
  }
  EXPECT_EQ(sidecarText(read.info), sidecarText(written.info));
  writeRecording(read, folder.file("again.csv"));
  EXPECT_EQ(readText(folder.file("again.csv")), readText(folder.file("run.csv")));
  EXPECT_EQ(readText(folder.file("again.json")), readText(folder.file("run.json")));
}

TEST(Recording, WritingRefusesWhatCouldNotBeReadAndLeavesNoFile) {
  const TemporaryFolder folder;
  const auto refuses = [&](const std::function<void(Recording&)>& spoil) {
    auto recording = sample();
    spoil(recording);
    EXPECT_THROW(writeRecording(recording, folder.file("run.csv")), BadParameter);
    EXPECT_EQ(folder.fileCount(), 0u);
  };
  refuses([](Recording& r) { r.signals[0].values.pop_back(); });
  refuses([](Recording& r) { r.signals[0].values[5] = 2; });
  refuses([](Recording& r) { r.signals[0].values[5] = std::nan(""); });
  refuses([](Recording& r) { r.signals[2].values[5] = std::numeric_limits<double>::infinity(); });
  refuses([](Recording& r) { r.signals[2].name = "length_0_cm"; });
  refuses([](Recording& r) { r.signals[2].name = "pressure_0"; });
  refuses([](Recording& r) { r.time_s[5] = r.time_s[4]; });
  refuses([](Recording& r) { r.info.robot = ""; });
  refuses([](Recording& r) {
    r.time_s.clear();
    for (auto& signal : r.signals) signal.values.clear();
  });
  EXPECT_THROW(writeRecording(sample(), folder.file("run.json")), BadParameter);
}

TEST(Recording, AFolderThatCannotBeWrittenIsAnIoError) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      hasWords(messageOf<IoError>([&] { writeRecording(sample(), folder.file("missing/run.csv")); }), {"missing/run.csv", "No such file"}));
  writeText(folder.file("file"), "");
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { writeRecording(sample(), folder.file("file/run.csv")); }), {"Not a directory"}));
}

TEST(Recording, MissingFilesAreNamed) {
  const TemporaryFolder folder;
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { readRecording(folder.file("no.csv")); }), {"no.csv", "No such file"}));
  EXPECT_THROW(readRecording(folder.file(".")), IoError) << "a folder";
  writeText(folder.file("run.csv"), two_rows);
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readRecording(folder.file("run.csv")); }),
                       {"run.json: does not exist", "{\"format\": \"musclesim-recording-1\", \"robot\": \"rig\"}"}));
  writeText(folder.file("run.json"), minimal_sidecar);
  EXPECT_NO_THROW(readRecording(folder.file("run.csv")));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readRecording(folder.file("run.json")); }), {"is a sidecar"}));
}

/// One seeded random change of a text: bytes flipped, cut, doubled or swapped, or an unexpected piece inserted.
std::string mutated(std::string text, std::mt19937_64& random) {
  static const std::vector<std::string> odd_pieces = {",",
                                                      "\n",
                                                      "\r",
                                                      "\"",
                                                      "nan",
                                                      "inf",
                                                      "-",
                                                      "1e999",
                                                      "#",
                                                      std::string(1, '\0'),
                                                      "\xFF",
                                                      ";",
                                                      "{",
                                                      "}",
                                                      "[",
                                                      "null",
                                                      "_mm",
                                                      "time_s",
                                                      "command_1",
                                                      "e",
                                                      ".",
                                                      "\xEF\xBB\xBF",
                                                      "99999999999999999999"};
  const int count = 1 + static_cast<int>(random() % 4);
  for (int i = 0; i < count; ++i) {
    const std::size_t at = random() % (text.size() + 1);
    const std::size_t length = std::min<std::size_t>(random() % 12, text.size() - at);
    switch (random() % 6) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.resize(at);
        break;
      case 4:
        text.insert(at, odd_pieces[random() % odd_pieces.size()]);
        break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(' ' + random() % 64);
    }
  }
  return text;
}

TEST(Recording, RandomDamageIsReadOrRefusedButNeverCrashes) {
  const std::string csv =
      "# rig\ntime_s,command_0_kPa,pressure_0,force_0_N,length_0_m,angle_elbow_rad,hand_y_mm,activity\n"
      "0,300,0.5,10.5,0.2,0.1,-240,1\n0.01,310,0.51,,0.201,0.11,-241,2\n0.02,320,nan,1e1,0.202,-0.12,-242,3\n";
  const std::string json = R"({"format": "musclesim-recording-1", "robot": "rig", "robot_parameters": {"a": {"b": 1}, "c": "d"},
 "pressure_full_scale_kPa": 600, "noise_std": {"length_0_m": 0.05}, "active_effects": [{"id": "x", "parameters": {"y": "inf"}}], "seed": 3, "complete": false, "note": [1]})";
  EXPECT_NO_THROW(parseCsv(csv, json));
  std::mt19937_64 random(20240501);
  int read_count = 0;
  for (int i = 0; i < 20'000; ++i) {
    const bool damage_json = i % 3 == 0;
    try {
      const auto recording = parseCsv(damage_json ? csv : mutated(csv, random), damage_json ? mutated(json, random) : json);
      ++read_count;
      for (const auto& signal : recording.signals) ASSERT_EQ(signal.values.size(), recording.time_s.size());
      ASSERT_FALSE(recording.time_s.empty());
    } catch (const Error& error) {
      ASSERT_FALSE(std::string(error.what()).empty());
    }
  }
  EXPECT_GT(read_count, 1000) << "the damage should leave some files readable";
}

TEST(Recording, ReadsTheReferenceAndPracticeRecordings) {
  std::size_t count = 0;
  for (const char* below : {"data/practice", "reference/trajectories"}) {
    const auto folder = sharedFolder() / below;
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there; set MUSCLESIM_SHARED to read its recordings";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".csv") continue;
      Recording recording;
      ASSERT_NO_THROW(recording = readRecording(entry.path().string())) << entry.path();
      EXPECT_GT(recording.time_s.size(), 10u) << entry.path();
      EXPECT_TRUE(recording.notes.empty()) << entry.path() << ": " << recording.notes[0];
      ++count;
    }
  }
  EXPECT_GT(count, 0u);
  RecordProperty("recordings", static_cast<int>(count));
}

}  // namespace
}  // namespace musclesim
