#include "musclesim/base/file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <set>

#include "log/log_fixture.h"

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

TEST(File, TemporaryNamesDifferAlsoBetweenProcessesWithTheSameId) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.txt");
  // As two processes in two containers: both have the same process id and write their first file.
  const auto nameOfFirst = [&] {
    const FileReplacement mine(file, "x");
    for (const auto& entry : std::filesystem::directory_iterator(folder.file(""))) return entry.path().filename().string();
    return std::string();
  };
  std::set<std::string> names;
  for (int i = 0; i < 3; ++i) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      std::string name = nameOfFirst();
      const std::string id = std::to_string(getpid());
      if (const auto at = name.find(id); at != std::string::npos) name.replace(at, id.size(), "ID");
      _exit(writeAll(ends[1], name) == name.size() ? 0 : 1);
    }
    close(ends[1]);
    char name[256] = "";
    EXPECT_GT(read(ends[0], name, sizeof name - 1), 0);
    close(ends[0]);
    waitpid(child, nullptr, 0);
    names.insert(name);
  }
  EXPECT_EQ(names.size(), 3u);
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
  const TemporaryFolder folder;
  replaceFile(folder.file("hole"), "");
  std::filesystem::resize_file(folder.file("hole"), std::uintmax_t{1} << 40);  // takes no room on the disk
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readTextFile(folder.file("hole"), 1 << 20); }), {"hole", "1 MiB"}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([] { readTextFile("/dev/zero", 1 << 20); }), {"/dev/zero", "is a device"}));
}

TEST(File, WithinAFolderAreNamesThatDoNotLeadOut) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("in/deeper"));
  replaceFile(folder.file("out"), "");
  std::filesystem::create_symlink(folder.file("out"), folder.file("in/link"));
  std::filesystem::create_symlink(folder.file(""), folder.file("in/up"));
  for (const char* within : {"a", "./a", "deeper/a", "deeper/../a", "..a"}) EXPECT_TRUE(isWithin(folder.file("in"), within)) << within;
  for (const std::string& outside : {std::string("../out"), folder.file("in/a"), std::string("deeper/../../out"), std::string("link"),
                                     std::string("up/out"), std::string(".."), std::string("")})
    EXPECT_FALSE(isWithin(folder.file("in"), outside)) << outside;
}

}  // namespace
}  // namespace musclesim
