#include "sweep/claims.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "musclesim/base/error.h"
#include "sweep/sweep_fixture.h"

namespace musclesim {
namespace {

/// Runs an action in a child process that then exits without any clean-up.
void inAnotherProcess(const std::function<void()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
}

using ClaimsOfRows = SweepTest;

TEST_F(ClaimsOfRows, AreMadeByOneOfManyProcesses) {
  constexpr std::size_t row_count = 200;
  const std::string sweep = sweepOf(row_count);
  std::vector<pid_t> children;
  for (int i = 0; i < 4; ++i) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    {
      Claims claims(sweep, 60);
      std::ofstream mine(path("mine" + std::to_string(i)));
      for (std::size_t row = 0; row < row_count; ++row)
        if (claims.claim(row, 1)) mine << row << "\n";
    }
    _exit(0);
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  std::multiset<std::size_t> all;
  for (int i = 0; i < 4; ++i) {
    std::istringstream mine(contentOf(path("mine" + std::to_string(i))));
    for (std::size_t row = 0; mine >> row;) all.insert(row);
  }
  EXPECT_EQ(all.size(), row_count) << "each row once";
  EXPECT_EQ(std::set<std::size_t>(all.begin(), all.end()).size(), row_count);
}

TEST_F(ClaimsOfRows, OfALiveWorkerStand) {
  const std::string sweep = sweepOf(1);
  Claims first(sweep, 60);
  ASSERT_TRUE(first.claim(0, 1));
  EXPECT_FALSE(first.history(0).free);
  inAnotherProcess([&] {
    Claims second(sweep, 60);
    if (second.history(0).free || second.claim(0, 1)) _exit(1);
  });
}

TEST_F(ClaimsOfRows, OfAProcessThatVanishedAreFreeAtOnce) {
  const std::string sweep = sweepOf(1);
  inAnotherProcess([&] {
    auto* never_destroyed = new Claims(sweep, 60);
    if (!never_destroyed->claim(0, 1)) _exit(1);
    _exit(0);
  });
  Claims second(sweep, 60);
  const RowHistory history = second.history(0);
  EXPECT_TRUE(history.free);
  EXPECT_EQ(history.attempt_count, 1);
  EXPECT_EQ(history.kill_count, 1);
  EXPECT_TRUE(second.claim(0, 2));
  EXPECT_FALSE(second.history(0).free);
}

TEST_F(ClaimsOfRows, OfAnotherMachineAreFreeWhenItsHeartbeatIsOld) {
  const std::string sweep = sweepOf(1);
  const nlohmann::json claim = {{"worker", "far-1-1"}, {"host", "far"}, {"machine", "another boot"}, {"pid", 1}, {"begin", "1"}};
  writeFile(sweep + "/claims/000000.1", claim.dump());
  writeFile(sweep + "/workers/far-1-1", claim.dump());
  Claims here(sweep, 60);
  EXPECT_FALSE(here.history(0).free) << "its heartbeat is fresh";
  const timespec old[2] = {{time(nullptr) - 61, 0}, {time(nullptr) - 61, 0}};
  utimensat(AT_FDCWD, (sweep + "/workers/far-1-1").c_str(), old, 0);
  EXPECT_TRUE(here.history(0).free);
  writeFile(sweep + "/workers/far-1-1", claim.dump());
  EXPECT_FALSE(here.history(0).free);
  fs::remove(sweep + "/workers/far-1-1");
  EXPECT_TRUE(here.history(0).free) << "it has ended";
}

TEST_F(ClaimsOfRows, CountHowAttemptsEnded) {
  const std::string sweep = sweepOf(1);
  Claims claims(sweep, 60);
  const std::vector<AttemptEnd> ends = {AttemptEnd::crashed, AttemptEnd::abandoned, AttemptEnd::killed};
  for (int attempt = 1; attempt <= 3; ++attempt) {
    ASSERT_TRUE(claims.claim(0, attempt));
    EXPECT_FALSE(claims.history(0).free);
    claims.end(0, attempt, ends[static_cast<std::size_t>(attempt - 1)], "why " + std::to_string(attempt));
  }
  const RowHistory history = claims.history(0);
  EXPECT_TRUE(history.free);
  EXPECT_EQ(history.attempt_count, 3);
  EXPECT_EQ(history.crash_count, 1);
  EXPECT_EQ(history.kill_count, 1);
  EXPECT_EQ(history.message, "why 3");
}

TEST_F(ClaimsOfRows, ThatCannotBeReadAreOfWorkersThatAreGone) {
  for (const std::string text : {"", "{", "[1]", R"({"worker": 1, "pid": "x"})"}) {
    const std::string sweep = sweepOf(1, "sweep" + std::to_string(text.size())), file = sweep + "/claims/000000.1";
    writeFile(file, text);
    Claims claims(sweep, 60);
    EXPECT_FALSE(claims.history(0).free) << "it may be fresh and still on its way: " << text;
    const timespec old[2] = {{time(nullptr) - 61, 0}, {time(nullptr) - 61, 0}};
    utimensat(AT_FDCWD, file.c_str(), old, 0);
    const RowHistory history = claims.history(0);
    EXPECT_TRUE(history.free) << text;
    EXPECT_EQ(history.attempt_count, 1);
    EXPECT_EQ(history.kill_count, 1);
    EXPECT_TRUE(contains(history.message, "000000.1: is unreadable")) << history.message;
    EXPECT_TRUE(claims.claim(0, 2));
  }
}

TEST_F(ClaimsOfRows, AreOfWorkersWithDifferentNamesAlsoIfTheirProcessesHaveTheSameId) {
  const std::string sweep = sweepOf(1);
  const Claims first(sweep, 60), second(sweep, 60);
  EXPECT_NE(first.worker(), second.worker());
}

}  // namespace
}  // namespace musclesim
