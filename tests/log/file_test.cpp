#include "musclesim/log/file.h"

#include "log_fixture.h"
#include "musclesim/log/text_place.h"

namespace musclesim {
namespace {

TEST(File, ReplacesAsAWhole) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.txt");
  replaceFile(file, "old");
  {
    const FileReplacement abandoned(file, "half");
    EXPECT_EQ(readText(file), "old");
    EXPECT_EQ(folder.fileCount(), 2u);
  }
  EXPECT_EQ(folder.fileCount(), 1u);
  replaceFile(file, "new");
  EXPECT_EQ(readTextFile(file, 3), "new");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(File, ErrorsNameFileAndReason) {
  const TemporaryFolder folder;
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { replaceFile(folder.file("no/a.txt"), "x"); }), {"no/a.txt", "No such file or directory"}));
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { readTextFile(folder.file("a.txt"), 10); }), {"a.txt", "No such file or directory"}));
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { readTextFile(folder.file(""), 10); }), {"Is a directory"}));
  std::filesystem::create_directory(folder.file("d"));
  EXPECT_THROW(replaceFile(folder.file("d"), "x"), IoError);
  EXPECT_EQ(folder.fileCount(), 1u) << "the temporary file is gone";
}

TEST(File, LargerThanAllowedIsRefused) {
  EXPECT_TRUE(hasWords(messageOf<BadFile>([] { readTextFile("/dev/zero", 1 << 20); }), {"/dev/zero", "1 MiB"}));
}

TEST(TextPlace, CountsFromOne) {
  const std::string text = "ab\nc\n";
  EXPECT_EQ(placeInText(text, 0).line, 1);
  EXPECT_EQ(placeInText(text, 1).column, 2);
  EXPECT_EQ(placeInText(text, 3).line, 2);
  EXPECT_EQ(placeInText(text, 3).column, 1);
  EXPECT_EQ(placeInText(text, 99).line, 3);
}

}  // namespace
}  // namespace musclesim
