#include "musclesim/log/recorder.h"

#include <sys/resource.h>
#include <sys/wait.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "log_fixture.h"
#include "support/support.h"

namespace musclesim {
namespace {

RecordingInfo rigInfo() {
  RecordingInfo info;
  info.robot = "rig";
  return info;
}

const std::vector<std::string> columns = {"command_0", "length_0_mm"};

nlohmann::json sidecarOf(const std::string& csv_file) {
  return nlohmann::json::parse(readText(sidecarPath(csv_file)));
}

std::size_t lineCount(const std::string& file) {
  const std::string text = readText(file);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Recorder, WritesARecording) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  Recorder recorder(file, rigInfo(), columns);
  EXPECT_EQ(sidecarOf(file)["complete"], false);
  EXPECT_EQ(readText(file), "time_s,command_0,length_0_mm\n") << "the header is there from the beginning";
  for (int i = 0; i < 1000; ++i) recorder.append(i * 0.01, {0.5, i % 3 ? 200 + i / 3.0 : std::nan("")});
  EXPECT_EQ(recorder.rowCount(), 1000);
  EXPECT_EQ(recorder.csvFile(), file);
  recorder.note("substeps", "20");
  recorder.note("substeps", "40");
  recorder.note("seed", "9");
  recorder.close(true);
  recorder.close(false);
  EXPECT_EQ(folder.fileCount(), 2u);
  const auto recording = readRecording(file);
  EXPECT_EQ(recording.info.complete, true);
  EXPECT_EQ(recording.info.seed, 9u);
  EXPECT_EQ(sidecarOf(file)["substeps"], 40);
  ASSERT_EQ(recording.time_s.size(), 1000u);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(recording.time_s[i], i * 0.01);
    const double length_mm = recording.find("length_0_mm")->values[i];
    EXPECT_TRUE(i % 3 ? length_mm == 200 + i / 3.0 : std::isnan(length_mm));
  }
}

TEST(Recorder, RowsReachTheFileEvery256RowsAndEverySecond) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  Recorder recorder(file, rigInfo(), columns);
  for (int i = 0; i < 256; ++i) recorder.append(i, {0, 0});
  EXPECT_EQ(lineCount(file), 257u);
  recorder.append(256, {0, 0});
  EXPECT_EQ(lineCount(file), 257u);
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  recorder.append(257, {0, 0});
  EXPECT_EQ(lineCount(file), 259u);
}

TEST(Recorder, DestructorLeavesAnIncompleteRecording) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  {
    Recorder recorder(file, rigInfo(), columns);
    recorder.append(0, {0, 1});
    recorder.note("stop_reason", "\"the simulation diverged\"");
  }
  const auto recording = readRecording(file);
  EXPECT_EQ(recording.time_s.size(), 1u);
  EXPECT_EQ(recording.info.complete, false);
  EXPECT_EQ(sidecarOf(file)["stop_reason"], "the simulation diverged");
}

TEST(Recorder, ReplacesAnOlderCompleteRecordingAtOnce) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  {
    Recorder older(file, rigInfo(), columns);
    older.append(0, {0, 1});
    older.close(true);
  }
  Recorder recorder(file, rigInfo(), columns);
  EXPECT_EQ(sidecarOf(file)["complete"], false);
  EXPECT_EQ(lineCount(file), 1u);
}

TEST(Recorder, RefusesWhatCouldNotBeRead) {
  const TemporaryFolder folder;
  EXPECT_THROW(Recorder(folder.file("run.txt"), rigInfo(), columns), BadParameter);
  EXPECT_THROW(Recorder(folder.file("run.csv"), {}, columns), BadParameter) << "no robot";
  EXPECT_THROW(Recorder(folder.file("run.csv"), rigInfo(), {"length_0_mm"}), BadParameter);
  EXPECT_EQ(folder.fileCount(), 0u);
  Recorder recorder(folder.file("run.csv"), rigInfo(), columns);
  recorder.append(1, {0, 0});
  EXPECT_THROW(recorder.append(1, {0, 0}), BadParameter);
  EXPECT_THROW(recorder.append(2, {0}), BadParameter);
  EXPECT_EQ(recorder.rowCount(), 1);
  EXPECT_THROW(recorder.note("complete", "true"), BadParameter);
  EXPECT_THROW(recorder.note("verdict", "{"), BadParameter);
  recorder.close(true);
  EXPECT_THROW(recorder.append(3, {0, 0}), BadParameter);
}

TEST(Recorder, AFullDiskIsAnIoErrorAndNeverComplete) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  std::filesystem::create_symlink("/dev/full", file);
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { Recorder(file, rigInfo(), columns); }), {"run.csv", "cannot be written", "No space left"}));
  EXPECT_EQ(sidecarOf(file)["complete"], false);
}

TEST(Recorder, AFolderThatCannotBeWrittenIsAnIoError) {
  const TemporaryFolder folder;
  EXPECT_TRUE(hasWords(messageOf<IoError>([&] { Recorder(folder.file("no/run.csv"), rigInfo(), columns); }), {"no/run.", "No such file"}));
  EXPECT_TRUE(
      hasWords(messageOf<IoError>([] { Recorder("/proc/run.csv", rigInfo(), columns); }), {"/proc/run.", "cannot be opened for writing"}));
  if (geteuid() == 0) return;  // root may write anywhere
  std::filesystem::permissions(folder.file("."), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THROW(Recorder(folder.file("run.csv"), rigInfo(), columns), IoError);
  std::filesystem::permissions(folder.file("."), std::filesystem::perms::owner_all);
}

/// Call in a child process: limits the size of every file to `bytes`.
void limitFileSize(rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(9);
}

TEST(Recorder, ADiskThatFillsUpDuringTheRunLosesOnlyWhatDoesNotFit) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    limitFileSize(20'000);
    Recorder recorder(file, rigInfo(), columns);
    try {
      for (int i = 0; i < 100'000; ++i) recorder.append(i * 0.01, {0.5, 200 + i / 3.0});
      _exit(1);
    } catch (const IoError&) {
    }
    try {
      recorder.close(true);
      _exit(2);
    } catch (const IoError& error) {
      _exit(std::string(error.what()).find("File too large") == std::string::npos ? 3 : 0);
    }
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const auto recording = readRecording(file);
  EXPECT_EQ(recording.info.complete, false);
  EXPECT_EQ(std::filesystem::file_size(file), 20'000u);
  EXPECT_GT(recording.time_s.size(), 500u);
}

/// Records until it is killed and reports the number of appended rows through the pipe.
[[noreturn]] void recordForever(const std::string& file, int counter) {
  Recorder recorder(file, rigInfo(), columns);
  for (std::uint32_t i = 0;; ++i) {
    recorder.append(i * 0.01, {0.5, 200 + i / 3.0});
    const std::uint32_t count = i + 1;
    if (pwrite(counter, &count, sizeof count, 0) != sizeof count) _exit(9);
  }
}

TEST(Recorder, KilledAtAnyMomentItLeavesAReadableIncompleteRecording) {
  const TemporaryFolder folder;
  std::mt19937 random(4);
  const int trial_count = longTests() ? 200 : 25;
  for (int trial = 0; trial < trial_count; ++trial) {
    const std::string file = folder.file("run" + std::to_string(trial) + ".csv");
    FILE* counter = std::tmpfile();
    ASSERT_TRUE(counter);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) recordForever(file, fileno(counter));
    std::uint32_t appended = 0;
    // Wait for the first rows on the disk, then for a random moment.
    while (pread(fileno(counter), &appended, sizeof appended, 0) < static_cast<ssize_t>(sizeof appended) || appended < 300)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20'000));
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(pread(fileno(counter), &appended, sizeof appended, 0), static_cast<ssize_t>(sizeof appended));
    std::fclose(counter);
    const auto recording = readRecording(file);
    EXPECT_EQ(recording.info.complete, false);
    // The row that was being appended may or may not have been counted.
    EXPECT_LE(recording.time_s.size(), appended + 1u);
    EXPECT_GE(recording.time_s.size() + 256, appended);
    const std::size_t last = recording.time_s.size() - 1;
    EXPECT_EQ(recording.find("length_0_mm")->values[last], 200 + static_cast<double>(last) / 3.0);
  }
}

}  // namespace
}  // namespace musclesim
