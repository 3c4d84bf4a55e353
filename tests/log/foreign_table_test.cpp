/// Tables as instruments and other programs write them: each kind of writing, of clock and of unit with the right values.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "log/data_table.h"
#include "log/table_look.h"
#include "musclesim/base/error.h"
#include "musclesim/log/import.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class ForeignTable : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_foreign_table_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  Recording import(const std::string& table, const std::string& mapping) {
    return importTable(write("data.csv", table), readImportMapping(write("map.toml", head + mapping)));
  }
  std::string refusal(const std::string& table, const std::string& mapping) {
    return messageOf<BadFile>([&] { import(table, mapping); });
  }
  static std::vector<double> values(const Recording& recording, const std::string& name) { return recording.find(name)->values; }
  static bool hasNote(const Recording& recording, const std::string& text) {
    return std::ranges::any_of(recording.notes, [&](const std::string& note) { return contains(note, text); });
  }

  const std::string head = "robot = \"rig\"\npressure_full_scale_kPa = 600\n";
  const std::string plain = "[columns]\ntime_s = \"t\"\ncommand_0_bar = \"u\"\nlength_0_mm = \"x\"\n";
  const std::string numbered = "[columns]\ntime_s = { from = 1 }\ncommand_0_bar = { from = 2 }\nlength_0_mm = { from = 3 }\n";
  fs::path folder_;
};

using Values = std::vector<double>;

TEST_F(ForeignTable, SemicolonsWithDecimalCommas) {
  const Recording r = import("t;u;x\n0;0,6;250,5\n0,1;1,2;-1e1\n", "[table]\nseparator = \";\"\ndecimal = \",\"\n" + plain);
  EXPECT_EQ(r.time_s, (Values{0, 0.1}));
  EXPECT_EQ(values(r, "command_0"), (Values{0.1, 0.2}));
  EXPECT_EQ(values(r, "length_0_mm"), (Values{250.5, -10}));
  EXPECT_TRUE(contains(refusal("t;u;x\n0;0,6;250.5\n", "[table]\nseparator = \";\"\ndecimal = \",\"\n" + plain), "a decimal comma"));
}

TEST_F(ForeignTable, QuotesUnitsRowAndLinesBeforeTheHeader) {
  const Recording r = import("Tester 5, run 3\n\nt,\"u\",x\n(s),(bar),(mm)\n\"0.0\",\"3\",\"250\"\n\"0.1\",\"3\" , \"249\"\n",
                             "[table]\nskip_before_header = 1\nskip_after_header = 1\n" + plain);
  EXPECT_EQ(values(r, "length_0_mm"), (Values{250, 249}));
  EXPECT_TRUE(contains(refusal("t,u,x\n(s),(bar),(mm)\n0,3,250\n", plain), "data.csv:2:1: column t: \"(s)\" is not a number"));
  EXPECT_TRUE(contains(refusal("t,u,x\n(s),(bar),(mm)\n0,3,250\n", plain), "needs skip_after_header = 1"));
  EXPECT_TRUE(contains(refusal("t,u,x\n0,\"3,250\n", plain), "data.csv:2:3: the quote is not closed"));
  const Recording separators =
      import("t,\"u, set\",x\n0,3,250\n", "[columns]\ntime_s = \"t\"\ncommand_0_bar = \"u, set\"\nlength_0_mm = \"x\"\n");
  EXPECT_EQ(values(separators, "command_0"), (Values{0.5}));
}

TEST_F(ForeignTable, TrailingSeparatorsAndShortRows) {
  const Recording r = import("t,u,x,Start,\n0,3,250,\n0.1,3,249,\n", plain);
  EXPECT_EQ(values(r, "length_0_mm"), (Values{250, 249}));
  EXPECT_EQ(r.notes.size(), 1U) << "all rows are like this";
  const Recording lost = import("t,u,x\n0,3,250\n0.1,3\n0.2,3,248\n", plain);
  EXPECT_TRUE(hasNote(lost, "1 of 3 rows have fewer cells than the table has columns, the first in line 3"));
  EXPECT_TRUE(std::isnan(values(lost, "length_0_mm")[1]));
  EXPECT_TRUE(contains(refusal("t,u,x\n0,3,250,7\n", plain), "the row has 4 cells but the header in line 1 names 3 columns"));
}

TEST_F(ForeignTable, NoHeaderBlanksAndTabs) {
  const Recording blanks = import(" 0  3 250\n0.1 3  248 \n", "[table]\nseparator = \" \"\nheader = false\n" + numbered);
  EXPECT_EQ(values(blanks, "length_0_mm"), (Values{250, 248}));
  const Recording tabs = import("0\t3\t250\n0.1\t3\t248\n", "[table]\nseparator = \"\\t\"\nheader = false\n" + numbered);
  EXPECT_EQ(values(tabs, "length_0_mm"), (Values{250, 248}));
  EXPECT_TRUE(contains(refusal("0,3,250\n0.1,3,248\n", numbered), "data.csv:1:1: the first row holds numbers: a table without a header?"));
  EXPECT_TRUE(contains(refusal("t,u\n0,3\n", numbered), "there is no column 3: the table has 2 columns"));
}

TEST_F(ForeignTable, CommentSigns) {
  EXPECT_EQ(values(import("% arm\nt,u,x\n0,3,250\n% pause\n0.1,3,248\n", "[table]\ncomment = \"%\"\n" + plain), "length_0_mm"),
            (Values{250, 248}));
  const Recording own =
      import("# t,u,x\n0,3,250\n", "[table]\ncomment = \"\"\n[columns]\ntime_s = \"# t\"\ncommand_0_bar = \"u\"\nlength_0_mm = \"x\"\n");
  EXPECT_EQ(values(own, "length_0_mm"), (Values{250}));
}

TEST_F(ForeignTable, Encodings) {
  const std::string columns = "[columns]\ntime_s = \"t\"\ncommand_0_bar = \"u\"\nlength_0_mm = \"L\xC3\xA4nge\"\n";
  EXPECT_EQ(values(import("t,u,L\xE4nge\n0,3,250\n", "[table]\nencoding = \"latin1\"\n" + columns), "length_0_mm"), (Values{250}));
  EXPECT_TRUE(contains(refusal("t,u,L\xE4nge\n0,3,250\n", columns), "the columns are t, u, \"L\\xE4nge\" (not UTF-8"));
  EXPECT_EQ(values(import("t,u,L\xE4nge\n0,3,250\n", numbered), "length_0_mm"), (Values{250})) << "a number needs no encoding";
  std::string wide = "\xFF\xFE";
  for (const char c : std::string("t,u,x\n0,3,250\n")) wide += std::string{c, '\0'};
  EXPECT_EQ(values(import(wide, plain), "length_0_mm"), (Values{250})) << "UTF-16 with its mark";
  EXPECT_TRUE(contains(refusal("t,u,x\n0,3,1\n", "[table]\nencoding = \"klingon\"\n" + plain), "encoding \"klingon\" is unknown"));
  EXPECT_TRUE(contains(refusal("t,u,\xC3\n0,3,1\n", "[table]\nencoding = \"utf-8\"\n" + plain), "data.csv:1:5: the byte \\xC3"));
}

TEST_F(ForeignTable, MarksOfMissingReadings) {
  const Recording r = import("t,u,x\n0,3,-nan\n1,3,nan(ind)\n2,3,1.#QNAN\n3,3,--\n4,3,-999.0\n5,3,250\n",
                             "[table]\nmissing = [\"--\", \"-999\"]\n" + plain);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(std::isnan(values(r, "length_0_mm")[static_cast<std::size_t>(i)])) << i;
  EXPECT_TRUE(hasNote(r, "length_0_mm: 5 of 6 cells hold no reading"));
  EXPECT_TRUE(contains(refusal("t,u,x\n0,3,250\n1,3,--\n", plain), "must stand in missing"));
}

TEST_F(ForeignTable, ANameThatIsThereTwice) {
  const std::string table = "t,u,x,t,x\n0,3,250,0,17\n0.1,3,248,0.1,18\n";
  EXPECT_TRUE(contains(refusal(table, plain),
                       "data.csv:1:7: several columns are named \"t\": 1 and 4; choose one by its number: from = 1 in a mapping"));
  EXPECT_EQ(values(import(table, numbered), "length_0_mm"), (Values{250, 248}));
  EXPECT_NO_THROW(import("t,u,x,y,y\n0,3,250,0,17\n", plain)) << "names that are not used may repeat";
}

TEST_F(ForeignTable, ALastLineThatIsCut) {
  const Recording r = import("t,u,x\n0,3,250\n0.1,3,248.5\n0.2,3,24", plain);
  EXPECT_EQ(values(r, "length_0_mm"), (Values{250, 248.5}));
  EXPECT_TRUE(hasNote(r, "the last line has no line end and may be cut; it is left out: \"0.2,3,24\""));
  const Recording jump = import("t,u,x\n0,3,250\n0.1,3,248.5\n0.2,3,24\n", plain);
  EXPECT_TRUE(hasNote(jump, "length_0_mm jumps from 248.5 to 24 in the last row"));
}

TEST_F(ForeignTable, ClocksInOtherUnits) {
  for (const auto& [unit, times] : {std::pair<std::string, std::string>{"s", "0.5 0.52"},
                                    {"ms", "500 520"},
                                    {"us", "500000 520000"},
                                    {"min", "0.0083333333333333 0.00866666666666"}}) {
    const auto blank = times.find(' ');
    const Recording r = import("t,u,x\n" + times.substr(0, blank) + ",3,250\n" + times.substr(blank + 1) + ",3,249\n",
                               "[columns]\ntime_" + unit + " = \"t\"\ncommand_0_bar = \"u\"\nlength_0_mm = \"x\"\n");
    EXPECT_EQ(r.time_s[0], 0) << unit;
    EXPECT_NEAR(r.time_s[1], 0.02, 1e-9) << unit;
  }
  const std::string rest = "command_0_bar = \"u\"\nlength_0_mm = \"x\"\n";
  const std::string table = "t,u,x\n100,3,250\n101,3,249\n103,3,248\n";
  EXPECT_EQ(import(table, "[columns]\ntime_s = { rate_Hz = 50 }\n" + rest).time_s, (Values{0, 0.02, 0.04})) << "rows of an even rate";
  EXPECT_EQ(import(table, "[columns]\ntime_s = { from = \"t\", rate_Hz = 50, offset = -2 }\n" + rest).time_s, (Values{0, 0.02, 0.06}))
      << "sample numbers";
  EXPECT_TRUE(contains(refusal(table, "[columns]\ntime_s = { from = \"t\", rate_Hz = 50, factor = 2 }\n" + rest), "cannot both be given"));
}

TEST_F(ForeignTable, DatesAndTimes) {
  const std::string rest = "command_0_bar = \"u\"\nlength_0_mm = \"x\"\n";
  const auto times = [&](const std::string& table, const std::string& clock) {
    return import(table, "[columns]\ntime_s = " + clock + "\n" + rest);
  };
  const Recording r = times("t,u,x,\n2025-03-09 22:55:50.814,1,250,\n2025-03-09 22:55:50.827,1,249,\n2025-03-09 22:55:50.839,2,248,\n",
                            "{ from = \"t\", format = \"%Y-%m-%d %H:%M:%S\" }");
  EXPECT_EQ(r.time_s, (Values{0, 0.013, 0.025}));
  EXPECT_TRUE(hasNote(r, "the clock begins at 1741560950.814 s; that becomes time 0"));
  EXPECT_EQ(times("d,t,u,x\n2026-01-01,23:59:59.990,1,250\n2026-01-02,00:00:00.000,1,249\n", "{ from = \"t\", date = \"d\" }").time_s,
            (Values{0, 0.01}));
  EXPECT_EQ(times("t,u,x\n2026-03-01T12:00:00.5+01:00,1,250\n2026-03-01T11:00:02Z,1,249\n", "{ from = \"t\", format = \"%Y-%m-%dT%T%z\" }")
                .time_s,
            (Values{0, 1.5}))
      << "zones";
  EXPECT_EQ(
      import("t;u;x\n01.02.2026 00:00:00,25;1;250\n01.02.2026 00:00:01,5;1;249\n",
             "[table]\nseparator = \";\"\ndecimal = \",\"\n[columns]\ntime_s = { from = \"t\", format = \"%d.%m.%Y %H:%M:%S\" }\n" + rest)
          .time_s,
      (Values{0, 1.25}));
  EXPECT_EQ(times("t,u,x\n1741560950.814,1,250\n1741560950.827,1,249\n", "{ from = \"t\" }").time_s, (Values{0, 0.013}))
      << "seconds since 1970";
  const std::string day = "t,u,x\n22:55:50,1,250\n22:55:51,1,249\n";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { times(day, "{ from = \"t\" }"); }), "for a date and time the clock needs a format"));
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { times(day, "{ from = \"t\", format = \"%H.%M\" }"); }),
                       "data.csv:2:1: \"22:55:50\" is no date and time of the format \"%H.%M\""));
}

TEST_F(ForeignTable, CountersThatBeginAgain) {
  const std::string table = "t,u,x\n4294.940,1,250\n4294.950,1,249\n0.0027,2,248\n0.0127,2,247\n";
  const std::string rest = "command_0_bar = \"u\"\nlength_0_mm = \"x\"\n";
  const Recording r = import(table, "[columns]\ntime_s = { from = \"t\", wraps_at_s = 4294.967296 }\n" + rest);
  EXPECT_NEAR(r.time_s[2], 0.029996, 1e-8);
  EXPECT_NEAR(r.time_s[3], 0.039996, 1e-8);
  EXPECT_TRUE(hasNote(r, "the clock begins again at 4294.967296 s, 1 times"));
  EXPECT_TRUE(contains(refusal(table, plain), "time runs backwards in data row 3 (line 4)"));
  EXPECT_TRUE(contains(refusal(table, plain), "needs wraps_at_s"));
  EXPECT_EQ(import("t,u,x\n23:59:59,1,250\n00:00:01,1,249\n",
                   "[columns]\ntime_s = { from = \"t\", format = \"%T\", wraps_at_s = 86400 }\n" + rest)
                .time_s,
            (Values{0, 2}));
}

/// A second logger beside valve.csv: rows at 0 .. 4 s.
class SecondTable : public ForeignTable {
 protected:
  Recording with(const std::string& other, const std::string& braces = "", const std::string& rest = "") {
    write("other.csv", other);
    return import(
        "t,u\n0,1\n1,2\n2,3\n3,2\n4,1\n",
        "[columns]\ntime_s = \"t\"\ncommand_0_bar = \"u\"\nlength_0_mm = { from = \"x\", table = \"other.csv\"" + braces + " }\n" + rest);
  }
};

TEST_F(SecondTable, NothingIsInventedOutsideOfItsTimes) {
  const Recording r = with("time_s,x\n0,250\n1,240\n");
  EXPECT_EQ(values(r, "length_0_mm")[1], 240);
  for (std::size_t row = 2; row < 5; ++row) EXPECT_TRUE(std::isnan(values(r, "length_0_mm")[row])) << row;
  EXPECT_TRUE(hasNote(r, "length_0_mm: 3 of 5 rows lie outside of its own times, 0 .. 1 s"));
}

TEST_F(SecondTable, NothingIsInventedInGaps) {
  const std::string other = "time_s,x\n0,250\n0.5,249\n3.5,240\n4,239\n";
  const Recording r = with(other);
  for (std::size_t row = 1; row < 4; ++row) EXPECT_TRUE(std::isnan(values(r, "length_0_mm")[row])) << row;
  EXPECT_EQ(values(r, "length_0_mm")[4], 239);
  EXPECT_TRUE(hasNote(r, "length_0_mm: 3 of 5 rows lie in gaps longer than 2.5 s"));
  EXPECT_EQ(values(with(other, "", "[rows]\nlongest_gap_s = 3\n"), "length_0_mm")[2], 244.5)
      << "unless the mapping says that they are short";
}

TEST_F(SecondTable, ClocksThatDoNotFitAreRefusedAndCanBeMadeToFit) {
  const std::string other_zero = "time_s,x\n100,250\n101,240\n102,230\n103,240\n104,250\n";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { with(other_zero); }),
                       "other.csv: length_0_mm: its clock runs from 100 to 104 s, the first table's from 0 to 4 s: they do not overlap"));
  EXPECT_EQ(values(with(other_zero, ", time_offset = -100"), "length_0_mm"), (Values{250, 240, 230, 240, 250}));
  const std::string milliseconds = "time_s,x\n0,250\n1000,240\n2000,230\n3000,240\n4000,250\n";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { with(milliseconds); }), "is its clock in milliseconds? Then give time_factor = 0.001"));
  EXPECT_EQ(values(with(milliseconds, ", time_factor = 0.001"), "length_0_mm"), (Values{250, 240, 230, 240, 250}));
}

TEST_F(SecondTable, HasItsOwnFormatAndClock) {
  write("other.csv", "200;250,5\n1200;240\n2200;230\n5200;1\n");
  const Recording r =
      import("t,u\n0,1\n1,2\n2,3\n",
             "[columns]\ntime_s = \"t\"\ncommand_0_bar = \"u\"\nlength_0_mm = { from = 2, table = \"other.csv\" }\n"
             "[tables.\"other.csv\"]\nseparator = \";\"\ndecimal = \",\"\nheader = false\ntime_ms = { from = 1, offset = -200 }\n");
  EXPECT_EQ(values(r, "length_0_mm"), (Values{250.5, 240, 230}));
}

TEST_F(ForeignTable, TwoClocksInOneTable) {
  const Recording r = import("t,u,t,x\n0,3,0,250\n1,3,0.5,249\n2,3,1.5,247\n3,3,,\n",
                             "[columns]\ntime_s = { from = 1 }\ncommand_0_bar = \"u\"\nlength_0_mm = { from = \"x\", time = 3 }\n");
  EXPECT_EQ(values(r, "length_0_mm")[1], 248);
  EXPECT_TRUE(std::isnan(values(r, "length_0_mm")[2]));
}

TEST_F(ForeignTable, ABeginningBeforeTheTable) {
  EXPECT_TRUE(contains(refusal("t,u,x\n0,1,250\n1,2,249\n", plain + "[rows]\nstep_s = 0.5\nfrom_s = -2\n"),
                       "rows.from_s: -2: the table begins at 0 s; for a rest before it give rows.before_s"));
}

TEST_F(ForeignTable, MergedTopicsHoldCommandsAndKeepReadings) {
  const std::string table = "t,u,x\n0.000,1,\n0.012,,250\n0.055,,249\n0.100,2,\n0.112,,248\n0.155,,240\n0.200,2,\n0.212,,239\n";
  const Recording r = import(table, plain);
  for (std::size_t row = 0; row < 8; ++row) EXPECT_NEAR(values(r, "command_0")[row], row < 3 ? 1 / 6.0 : 2 / 6.0, 1e-12) << row;
  EXPECT_TRUE(std::isnan(values(r, "length_0_mm")[3])) << "no reading in this row";
  EXPECT_EQ(values(r, "length_0_mm")[4], 248);
  const Recording even = import(table, plain + "[rows]\nstep_s = 0.05\n");
  EXPECT_TRUE(std::isnan(values(even, "length_0_mm")[0])) << "before the first reading";
  EXPECT_NEAR(values(even, "length_0_mm")[1], 250 - (0.05 - 0.012) / (0.055 - 0.012), 1e-6);
  EXPECT_NEAR(values(even, "command_0")[1], 1 / 6.0, 1e-12);
  const std::string late = "t,u,x\n0,,250\n1,3,249\n2,,248\n";
  EXPECT_TRUE(contains(refusal(late, plain), "command_0_bar: the first command comes at 1 s, after the first row"));
  EXPECT_EQ(values(import(late, plain + "[rows]\nbefore = { command_0_bar = 0 }\n"), "command_0"), (Values{0, 0.5, 0.5}));
}

TEST_F(ForeignTable, UnitsAndAbsolutePressures) {
  const std::string table = "t,a,b\n0,1013.25,660\n1,2013.25,661\n";
  for (const auto& [unit, kPa] :
       {std::pair<std::string, double>{"hPa", 0.1}, {"mbar", 0.1}, {"Pa", 1e-3}, {"kPa", 1}, {"psi", 6.894757293168361}}) {
    const Recording r = import(table, "[columns]\ntime_s = \"t\"\ncommand_0 = { value = 0 }\npressure_0_" + unit + " = { from = \"a\" }\n");
    EXPECT_NEAR(values(r, "pressure_0")[1], 2013.25 * kPa / 600, 1e-8) << unit;
  }
  const Recording gauge =
      import(table,
             "[columns]\ntime_s = \"t\"\ncommand_0_psi = { value = 87.0226413 }\npressure_0_hPa = { from = \"a\", ambient_kPa = 101.325 }\n"
             "length_0_inch = { value = 10 }\nforce_0_kN = { from = \"b\", factor = 0.001 }\n");
  EXPECT_NEAR(values(gauge, "pressure_0")[0], 0, 1e-12);
  EXPECT_NEAR(values(gauge, "pressure_0")[1], 1 / 6.0, 1e-9);
  EXPECT_NEAR(values(gauge, "command_0")[0], 1, 1e-7);
  EXPECT_NEAR(values(gauge, "length_0_mm")[0], 254, 1e-9);
  EXPECT_NEAR(values(gauge, "force_0_N")[0], 660, 1e-9);
  EXPECT_TRUE(contains(refusal(table, "[columns]\ntime_s = \"t\"\ncommand_0 = { from = \"a\", ambient_kPa = 100 }\n"),
                       "needs a column in a unit of pressure"));
}

TEST_F(ForeignTable, MappingsThatCannotBe) {
  const std::string table = "t,u,x\n0,1,250\n";
  EXPECT_TRUE(contains(refusal(table, "[table]\nseperator = \";\"\n" + plain), "did you mean \"separator\""));
  EXPECT_TRUE(contains(refusal(table, "[table]\nseparator = \"ab\"\n" + plain), "separator: must be one of the characters"));
  EXPECT_TRUE(contains(refusal(table, "[table]\ndecimal = \",\"\n" + plain), "separator and decimal must differ"));
  EXPECT_TRUE(contains(refusal(table, "[table]\nmissing = \"--\"\n" + plain), "missing: must be a list"));
  EXPECT_TRUE(
      contains(refusal(table, "[columns]\ntime_s = \"t\"\ncommand_0 = { from = 0 }\n"), "from: must be a column's name or its number"));
  EXPECT_TRUE(contains(refusal(table, "[columns]\ntime_s = \"t\"\ntime_ms = \"t\"\ncommand_0 = \"u\"\n"), "the time is given twice"));
}

TEST_F(ForeignTable, FaultsOfValuesHaveTheirPlaceInTheTableOrInTheMapping) {
  const std::string table = "t,u,x\n0,3,250\n0.1,700,249\n";
  EXPECT_TRUE(contains(refusal(table, plain), "data.csv:3:5: column u: \"700\" becomes command_0_bar = 700 (116.6"));
  EXPECT_TRUE(contains(refusal(table, plain + "[rows]\nbefore_s = 1\n"), "data.csv:3:5: column u: \"700\" becomes"));
  EXPECT_TRUE(contains(refusal("t,u,x\n0,700,250\n", plain + "[rows]\nbefore_s = 1\n"), "data.csv:2:3: column u: \"700\" becomes"));
  EXPECT_TRUE(
      contains(refusal("t,u,x\n0,3,250\n1,700,250\n2,3,250\n", plain + "[rows]\nfrom_s = 1\nbefore_s = 1\n"), "data.csv:3:3: column u"))
      << "the rest before the first row that is used";
  write("other.csv", "when,w\n0,3\n0.1,8\n");
  EXPECT_TRUE(contains(
      refusal("t,x\n0,250\n0.1,249\n",
              "[columns]\ntime_s = \"t\"\nlength_0_mm = \"x\"\ncommand_0_bar = { from = \"w\", table = \"other.csv\", time = \"when\" }\n"),
      "other.csv:3:5: column w: \"8\" becomes command_0_bar = 8"));
  EXPECT_TRUE(contains(refusal(table, "[columns]\ntime_s = \"t\"\ncommand_0_bar = { value = 7 }\nlength_0_mm = \"x\"\n"),
                       "map.toml:5:1: columns.command_0_bar: command_0_bar = 7"));
  EXPECT_TRUE(contains(refusal("t,u,x\n0,3,250\n", plain + "[rows]\nbefore_s = 1\nbefore = { command_0_bar = 9 }\n"),
                       "map.toml:9:12: rows.before.command_0_bar: command_0_bar = 9"));
}

TEST_F(ForeignTable, FaultsOfTheMappingHaveTheirPlaceInIt) {
  const std::string table = "t,valve,x\n0,3,250\n0.1,3,249\n", data = (folder_ / "data.csv").string();
  const auto columns = [](const std::string& time, const std::string& command) {
    return "[columns]\ntime_s = " + time + "\n" + command + "\nlength_0_mm = \"x\"\n";
  };
  for (const auto& [mapping, message] : std::vector<std::pair<std::string, std::string>>{
           {columns("\"t\"", "comand_0_bar = \"valve\""), "map.toml:5:1: columns.comand_0_bar: column \"comand_0_bar\": unknown quantity"},
           {columns("\"t\"", "comand_0_bar = \"valve\""), "did you mean \"command_0_bar\"?"},
           {columns("\"t\"", "command_0_bar = \"vlave\""), "map.toml:5:1: columns.command_0_bar: " + data +
                                                               ":1: there is no column \"vlave\"; "
                                                               "did you mean \"valve\"?"},
           {columns("\"t\"", "command_0_bar = { from = \"u\", table = \"othr.csv\" }"), "map.toml:5:31: columns.command_0_bar.table: "},
           {columns("{ from = 7 }", "command_0_bar = \"valve\""), "map.toml:4:1: columns.time_s: " + data + ":1: there is no column 7"},
           {columns("\"t\"", "command_0_V = \"valve\""), "map.toml:5:1: columns.command_0_V: command_0_V: V can be converted"},
           {columns("\"t\"", "command_1_bar = \"valve\""), "map.toml:3:2: columns: there is no column command_0"},
           {columns("\"t\"", "command_0 = \"valve\"\ncommand_0_bar = \"valve\""), "columns.command_0_bar: is the same column as command_0"},
           {"physics = \"moon\"\n" + columns("\"t\"", "command_0 = { value = 0 }"), "map.toml:3:1: physics = \"moon\": must be"},
           {"noise_std = { lenth_0_mm = 1 }\n" + columns("\"t\"", "command_0 = { value = 0 }"), "map.toml:3:1: noise_std: column"},
           {columns("\"t\"", "command_0 = { value = 0 }") + "[noise_std]\nlength_0_mm = -1\n", "map.toml:7:2: noise_std.length_0_mm = -1"},
           {"[tabel]\nseparator = \";\"\n" + columns("\"t\"", "command_0 = { value = 0 }"),
            "map.toml:3:2: tabel: a mapping has no such section; did you mean [table]?"},
           {columns("\"t\"", "command_0 = { value = 0 }") + "[rows]\nfrom_s = -3\n", "map.toml:8:1: rows.from_s: -3: the table begins"}})
    EXPECT_TRUE(contains(refusal(table, mapping), message)) << mapping;
  const Recording r = import(table, "presure_full_scale_kPa = 600\n" + columns("\"t\"", "command_0 = { value = 0 }"));
  EXPECT_TRUE(hasNote(r, "\"presure_full_scale_kPa\" (did you mean \"pressure_full_scale_kPa\"?)"));
}

TEST_F(ForeignTable, SaysHowOtherSeparatorsAndDecimalsAreRead) {
  const std::string table = "t;u;x\n0;0,6;250,5\n";
  EXPECT_TRUE(contains(refusal(table, plain), "data.csv:1:2: cells must be separated by commas"));
  EXPECT_TRUE(contains(refusal(table, plain), "needs separator = \";\""));
  EXPECT_TRUE(contains(refusal(table, "[table]\nseparator = \";\"\n" + plain), "data.csv:2:3: column u: \"0,6\" is not a number"));
  EXPECT_TRUE(contains(refusal(table, "[table]\nseparator = \";\"\n" + plain), "needs decimal = \",\""));
  EXPECT_TRUE(contains(refusal("t,u,x\n0,0,0,6,250,5\n", plain), "save it with semicolons between the cells"));
  EXPECT_TRUE(contains(refusal("t;u;x\n0;0.6;250\n", "[table]\nseparator = \";\"\ndecimal = \",\"\n" + plain), "needs decimal = \".\""));
}

TEST_F(ForeignTable, LookingShowsFormatColumnsAndClock) {
  const TableLook look = lookAtTable(
      write("look.csv", "Logger 3\nt [ms];p [hPa];name;F (N)\n0;1013,25;a;--\n10;1014,5;b;1,5\n20;1015;c;2\n500;1016;d;3\n510;1016;e;3\n"));
  EXPECT_EQ(look.format.separator, ';');
  EXPECT_EQ(look.format.decimal, ',');
  EXPECT_EQ(look.format.skip_before_header, 1);
  EXPECT_EQ(look.format.missing, (std::vector<std::string>{"--"}));
  ASSERT_EQ(look.columns.size(), 4U);
  EXPECT_EQ(look.columns[1].unit, "hPa");
  EXPECT_EQ(look.columns[1].lowest, 1013.25);
  EXPECT_EQ(look.columns[3].missing_count, 1U);
  ASSERT_TRUE(look.clock);
  EXPECT_EQ(look.clock->unit, "ms");
  EXPECT_NEAR(look.clock->step_s, 0.01, 1e-12);
  EXPECT_EQ(look.clock->gap_count, 1U);
  EXPECT_TRUE(contains(lookText(look), "1013.25 .. 1016 hPa, absolute?"));
  const std::string mapping = mappingText(look) + "";
  EXPECT_TRUE(contains(mapping, "# pressure_0_hPa = { from = \"p [hPa]\", ambient_kPa = 101.325 }"));
  std::string completed = mapping;
  completed.replace(completed.find("# command_0_bar = \"...\""), 23, "command_0 = { value = 0 }");
  completed.replace(completed.find("# force_0_N"), 11, "force_0_N");
  const Recording r = importTable((folder_ / "look.csv").string(), readImportMapping(write("begun.toml", completed)));
  EXPECT_EQ(r.time_s, (Values{0, 0.01, 0.02, 0.5, 0.51}));
  EXPECT_EQ(values(r, "force_0_N")[2], 2);
}

TEST_F(ForeignTable, LookingRecognisesOtherWritings) {
  const TableLook scope =
      lookAtTable(write("a.csv", "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-5.99e+00,1.0e-02\n0,1.6,1.8,\n1,1.4,3.0,\n2,1.5,1.1,\n"));
  EXPECT_EQ(scope.format.skip_after_header, 1);
  EXPECT_EQ(scope.clock->unit, "") << "sample numbers";
  const TableLook blanks = lookAtTable(write("b.txt", "0 1 250\n0.1 1 248\n0.2 2 247\n"));
  EXPECT_EQ(blanks.format.separator, ' ');
  EXPECT_FALSE(blanks.format.has_header);
  const TableLook dates = lookAtTable(write("c.csv", "A1,,\nd,t,u\n2026-01-01,23:59:59.990,1\n2026-01-02,00:00:00.000,1\n"));
  EXPECT_EQ(dates.clock->clock.format, "%Y-%m-%d %H:%M:%S");
  EXPECT_EQ(dates.clock->date_column, "d");
  EXPECT_NEAR(dates.clock->duration_s, 0.01, 1e-6);
  for (const auto& [first, format] : {std::pair<std::string, std::string>{"2026-01-31T10:00:00.5", "%Y-%m-%dT%H:%M:%S"},
                                      {"2026-01-31T10:00:00Z", "%Y-%m-%dT%H:%M:%S%z"},
                                      {"2026-01-31T10:00:00.25+01:00", "%Y-%m-%dT%H:%M:%S%z"},
                                      {"31.01.2026 10:00:00", "%d.%m.%Y %H:%M:%S"},
                                      {"01/31/2026 10:00:00", "%m/%d/%Y %H:%M:%S"},
                                      {"31/01/2026 10:00:00", "%d/%m/%Y %H:%M:%S"},
                                      {"10:00:00.125", "%H:%M:%S"}}) {
    const TableLook look = lookAtTable(write("z.csv", "t,u\n" + first + ",1\n" + first + ",2\n"));
    ASSERT_TRUE(look.clock) << first;
    EXPECT_EQ(look.clock->clock.format, format) << first;
  }
  const TableLook counter = lookAtTable(write("d.csv", "t,u\n4294.940,1\n4294.950,1\n0.0027,2\n0.0127,2\n"));
  EXPECT_EQ(counter.clock->clock.wraps_at_s, 4294.967296);
  const TableLook numpy = lookAtTable(write("e.txt", "# t u x\n0 1 250\n0.1 1 248\n0.2 2 247\n"));
  EXPECT_TRUE(numpy.format.comment.empty()) << "the header stands in a comment";
  EXPECT_THROW(lookAtTable(write("f.txt", "no table\nat all\n")), BadFile);
}

TEST_F(ForeignTable, LookingCountsMissingReadingsAsMissing) {
  const TableLook nan = lookAtTable(write("a.csv", "t,x\n0,NaN\n1,nan\n2,-nan(ind)\n3,1.#QNAN\n4,5\n5,6\n"));
  EXPECT_TRUE(nan.columns[1].is_number);
  EXPECT_EQ(nan.columns[1].missing_count, 4U);
  EXPECT_TRUE(nan.format.missing.empty()) << "the reader knows these words";
  const TableLook marks = lookAtTable(write("b.csv", "t,x\n0,--\n1,--\n2,--\n3,5\n4,6\n"));
  EXPECT_EQ(marks.format.missing, (std::vector<std::string>{"--"}));
  EXPECT_TRUE(contains(lookText(marks), "5 .. 6, 3 missing"));
  const TableLook beyond = lookAtTable(write("c.csv", "t,x\n0,1\n1,inf\n2,2\n3,5\n4,6\n"));
  EXPECT_EQ(beyond.format.missing, (std::vector<std::string>{"inf"})) << "the reader refuses infinite readings";
  const TableLook events = lookAtTable(write("d.csv", "t,x,event\n0,1,start\n1,2,\n2,2,\n3,5,\n4,6,stop\n"));
  EXPECT_TRUE(events.format.missing.empty()) << "a column of words has no readings to miss";
}

TEST_F(ForeignTable, LookingSaysWhatIsWrongWithAClock) {
  const TableLook bad = lookAtTable(write("a.csv", "t,x\n0,1\n0.1,2\nERR,3\n0.3,4\n0.4,5\n"));
  ASSERT_TRUE(bad.clock);
  EXPECT_TRUE(bad.clock->fault.empty());
  EXPECT_NEAR(bad.clock->duration_s, 0.4, 1e-12);
  EXPECT_EQ(bad.format.missing, (std::vector<std::string>{"ERR"}));
  EXPECT_FALSE(contains(lookText(bad), "backwards"));
  const TableLook words = lookAtTable(write("b.csv", "t,x\n0,1\n0.1,2\na1,3\nb2,4\nc3,3\nd4,3\ne5,3\n0.7,5\n0.8,6\n0.9,6\n1,6\n"));
  EXPECT_TRUE(contains(words.clock->fault, "line 4: column t: \"a1\" is not a number"));
  const TableLook back = lookAtTable(write("c.csv", "t,x\n0,1\n1,2\n2,3\n0.5,4\n1.5,5\n2.5,5\n"));
  EXPECT_TRUE(contains(lookText(back), "clock, but line 5: time runs backwards in data row 4 (line 5): 0.5 after 2"));
}

TEST_F(ForeignTable, AColumnInAnotherUnitIsNoClock) {
  EXPECT_FALSE(lookAtTable(write("a.csv", "motion,angle_deg\na,1\nb,2\nc,3\n")).clock);
  EXPECT_TRUE(lookAtTable(write("b.csv", "motion,n\na,1\nb,2\nc,3\n")).clock);
}

TEST_F(ForeignTable, LookingMentionsWhatIsThereTwice) {
  const TableLook look = lookAtTable(
      write("a.csv", "time [s],p [bar],p2 [bar],x [mm],x [mm]\n0,2,2,3,5\n0,2,2,3,5\n0,2,2,3,5\n1,2,2,3,5\n1,2,2,3,5\n1,2,2,3,5\n"));
  ASSERT_TRUE(look.clock) << "a coarse clock";
  EXPECT_TRUE(contains(lookText(look), "4 rows have the time of the row before"));
  EXPECT_TRUE(contains(lookText(look), "another column has the same name: refer to it by its number"));
  const std::string mapping = mappingText(look);
  for (const char* line : {"# pressure_0_bar = \"p [bar]\"", "# pressure_1_bar = \"p2 [bar]\"", "# length_0_mm = { from = 4 }",
                           "# length_1_mm = { from = 5 }"})
    EXPECT_TRUE(contains(mapping, line));
}

TEST_F(ForeignTable, AMappingOfVoltagesSaysTheirFullScale) {
  const std::string volts = mappingText(lookAtTable(write("a.csv", "time [s],u [V]\n0,2\n1,3\n2,4\n")));
  EXPECT_TRUE(contains(volts, "\ncommand_full_scale_V = 10 ") && contains(volts, "# command_0_V = \"u [V]\"")) << volts;
  const std::string bar = mappingText(lookAtTable(write("b.csv", "time [s],u [bar]\n0,2\n1,3\n2,4\n")));
  EXPECT_FALSE(contains(bar, "full_scale_V")) << bar;
}

TEST_F(ForeignTable, LookingShowsRangesThatCanBeRead) {
  const TableLook epoch = lookAtTable(write("a.csv", "time,x\n1741560950.25,1\n1741560955.25,2\n1741560960.25,3\n"));
  EXPECT_TRUE(contains(lookText(epoch), "1741560950.25 .. 1741560960.25 (2025-03-09 22:55:50 .. 2025-03-09 22:56:00 UTC)"));
  const TableLook counter = lookAtTable(write("b.csv", "time_us,x\n10000000,1\n10010000,2\n10020000,3\n"));
  EXPECT_TRUE(contains(lookText(counter), "10000000 .. 10020000 us"));
}

TEST_F(ForeignTable, CommandsOfAClockThatIsRoundedAreThoseOfTheirRows) {
  for (const double step_s : {0.005, 0.01, 0.02}) {
    std::string table = "t,u,x\n";
    for (int row = 0; row < 400; ++row) table += fmt::format("{:.3f},{:.3f},250\n", 0.3 + row * step_s, 0.006 * (row % 100));
    const Recording r = import(table, plain + fmt::format("[rows]\nstep_s = {}\n", step_s));
    ASSERT_EQ(r.time_s.size(), 400U);
    for (int row = 0; row < 400; ++row)
      ASSERT_NEAR(values(r, "command_0")[static_cast<std::size_t>(row)], 0.001 * (row % 100), 1e-9) << "step " << step_s << ", row " << row;
  }
}

}  // namespace
}  // namespace musclesim
