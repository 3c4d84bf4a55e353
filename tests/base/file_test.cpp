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
  EXPECT_TRUE(hasWords(messageOf<BadFile>([] { readTextFile("/dev/zero", 1 << 20); }), {"/dev/zero", "1 MiB"}));
}

}  // namespace
}  // namespace musclesim
