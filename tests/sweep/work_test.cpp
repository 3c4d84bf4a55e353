#include "sweep/work.h"

#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "musclesim/base/error.h"
#include "src/program.h"
#include "sweep/collect.h"
#include "sweep/result.h"
#include "sweep/sweep_fixture.h"

namespace musclesim {
namespace {

const std::string good_end = "echo '{\"twice\": '$(($1 * 2))'}'";

class Working : public SweepTest {
 protected:
  WorkSummary workWith(const std::string& program, const std::string& sweep) {
    WorkOptions options = options_;
    options.program = program;
    return work(sweep, options);
  }

  /// Starts a worker in a child process.
  pid_t startWorker(const std::string& program, const std::string& sweep) {
    const pid_t child = fork();
    if (child == 0) {
      workWith(program, sweep);
      _exit(0);
    }
    return child;
  }

  static void waitFor(const fs::path& file) {
    for (int i = 0; i < 1000 && !fs::exists(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(fs::exists(file));
  }

  WorkOptions options_;
};

TEST_F(Working, RunsEveryRowOnceAndKeepsItsOutput) {
  const std::string sweep = sweepOf(5);
  const WorkSummary summary = workWith(script("echo $1 >>" + path("runs") + "; echo out >$2/file.txt; " + good_end), sweep);
  EXPECT_EQ(summary.done_count, 5u);
  EXPECT_EQ(contentOf(path("runs")), "0\n1\n2\n3\n4\n");
  EXPECT_EQ(contentOf(sweep + "/outputs/000003/file.txt"), "out\n");
  EXPECT_EQ(readResult(sweep, 3).numbers.at("twice"), 6);
  EXPECT_TRUE(collect(sweep).complete());
  EXPECT_EQ(workWith(script("exit 1"), sweep).done_count, 0u) << "nothing is left to do";
}

TEST_F(Working, RepeatsACrashOnceAndThenSaysSo) {
  const std::string sweep = sweepOf(3);
  // Row 0 crashes on its first try, row 1 always.
  const std::string program = script("echo $1 >>" + path("runs") + "\n[ $1 = 1 ] && kill -SEGV $$\n[ $1 = 0 ] && [ ! -e " + path("once") +
                                     " ] && touch " + path("once") + " && kill -SEGV $$\n" + good_end);
  const WorkSummary summary = workWith(program, sweep);
  EXPECT_EQ(summary.done_count, 2u);
  EXPECT_EQ(summary.crashed_count, 1u);
  EXPECT_EQ(contentOf(path("runs")), "0\n0\n1\n1\n2\n");
  EXPECT_EQ(readResult(sweep, 0).attempt_count, 2);
  EXPECT_TRUE(contains(readResult(sweep, 1).message, "signal 11"));
  EXPECT_EQ(collect(sweep).crashed, std::vector<std::size_t>{1});
}

TEST_F(Working, RepeatsWhatIsKilledFromOutsideUpToFiveTimes) {
  const std::string sweep = sweepOf(1);
  const WorkSummary summary = workWith(script("echo $1 >>" + path("runs") + "; kill -KILL $$"), sweep);
  EXPECT_EQ(summary.crashed_count, 1u);
  EXPECT_EQ(contentOf(path("runs")), "0\n0\n0\n0\n0\n");
}

TEST_F(Working, ARunThatIsTerminatedShortlyBeforeItsWorkerIsGivenBack) {
  const std::string sweep = sweepOf(1);
  int asked_since = 0;
  options_.interrupt_signal = [&] { return fs::exists(path("ended")) && ++asked_since > 5 ? SIGTERM : 0; };
  EXPECT_EQ(workWith(script("touch " + path("ended") + "; kill -TERM $$"), sweep).end, WorkSummary::End::interrupted);
  EXPECT_TRUE(contains(contentOf(sweep + "/claims/000000.1.end"), "abandoned"));
}

TEST_F(Working, TellsDivergedAndFailedRowsApart) {
  const std::string sweep = sweepOf(3);
  const WorkSummary summary =
      workWith(script("echo musclesim: error: words >&2; echo more >&2; case $1 in 0) exit 4;; 1) exit 2;; esac; " + good_end), sweep);
  EXPECT_EQ(summary.diverged_count, 1u);
  EXPECT_EQ(summary.failed_count, 1u);
  EXPECT_EQ(readResult(sweep, 1).message, "musclesim: error: words");
  const Collected collected = collect(sweep);
  EXPECT_EQ(collected.diverged, std::vector<std::size_t>{0});
  EXPECT_EQ(collected.failed, std::vector<std::size_t>{1});
}

TEST_F(Working, KnowsTheExitStatusAlsoWhereEndsOfProcessesAreIgnored) {
  const std::string sweep = sweepOf(1);
  const auto before = signal(SIGCHLD, SIG_IGN);
  const WorkSummary summary = workWith(script("exit 2"), sweep);
  signal(SIGCHLD, before);
  EXPECT_EQ(summary.failed_count, 1u);
  EXPECT_EQ(readResult(sweep, 0).status, "failed");
  EXPECT_EQ(readResult(sweep, 0).exit_status, 2);
}

TEST_F(Working, AnEndThatIsNotKnownIsAnError) {
  const ChildCommand command{script("exec sleep 0.1"), {}, path(""), path("out"), path("error")};
  const auto taken_away = [] {
    waitpid(-1, nullptr, 0);
    return false;
  };
  EXPECT_TRUE(contains(messageOf<IoError>([&] { runChild(command, taken_away); }), "its end is not known"));
}

TEST_F(Working, RowsWithoutTheNumbersThatAreExpectedHaveFailed) {
  Sweep sweep;
  sweep.command = {"{x}", "{out}"};
  sweep.columns = {"twice"};
  for (const double x : {0.0, 1.0, 2.0}) sweep.rows.push_back({{{"x", x}}, {}});
  writeSweep(sweep, path("sweep"));
  const WorkSummary summary = workWith(script("case $1 in 0) echo words;; 1) echo '{}';; *) " + good_end + ";; esac"), path("sweep"));
  EXPECT_EQ(summary.failed_count, 2u);
  EXPECT_EQ(summary.done_count, 1u);
  EXPECT_EQ(readResult(path("sweep"), 0).message, "gave no numbers");

  const std::string with_json = sweepOf(1, "json", {"{x}", "--json"}), without = sweepOf(1, "plain", {"{x}"});
  EXPECT_EQ(workWith(script("echo words"), with_json).failed_count, 1u);
  EXPECT_EQ(workWith(script("echo words"), without).done_count, 1u) << "nothing asks for numbers";
}

TEST_F(Working, EndsRowsThatTakeTooLong) {
  Sweep sweep;
  sweep.command = {"{x}", "{out}"};
  sweep.rows = {{{{"x", 1.0}}, {}}};
  sweep.row_time_limit_s = 0.2;
  writeSweep(sweep, path("sweep"));
  EXPECT_EQ(workWith(script("exec sleep 100"), path("sweep")).crashed_count, 1u);
  EXPECT_TRUE(contains(readResult(path("sweep"), 0).message, "longer than 0.2 s"));
}

TEST_F(Working, StopsBeforeTheTimeLimitAndGivesTheRowBack) {
  const std::string sweep = sweepOf(2);
  options_.time_limit_s = 1.5;
  const auto begin = std::chrono::steady_clock::now();
  const WorkSummary summary = workWith(script("exec sleep 100"), sweep);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(1500));
  EXPECT_EQ(summary.end, WorkSummary::End::time_limit);
  EXPECT_EQ(collect(sweep).missing.size(), 2u);
  options_ = {};
  EXPECT_EQ(workWith(script(good_end), sweep).done_count, 2u) << "both rows can be taken at once";
  EXPECT_EQ(readResult(sweep, 0).attempt_count, 2);
}

TEST_F(Working, TakesOverFromAWorkerThatIsKilledInTheMiddleOfARow) {
  const std::string sweep = sweepOf(6);
  // On its first try row 2 waits until its worker is dead.
  const std::string program =
      script("[ $1 = 2 ] && [ ! -e " + path("waiting") + " ] && echo $$ >" + path("waiting") + " && exec sleep 100\n" + good_end);
  const pid_t first = startWorker(program, sweep);
  waitFor(path("waiting"));
  const pid_t second = startWorker(program, sweep);
  waitFor(sweep + "/results/000005.json");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(fs::exists(sweep + "/results/000002.json")) << "a live worker's row is left to it";
  kill(first, SIGKILL);
  waitpid(first, nullptr, 0);
  int status = 0;
  waitpid(second, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(collect(sweep).complete());
  EXPECT_EQ(readResult(sweep, 2).attempt_count, 2);
  // The run ended together with its worker.
  std::string pid;
  std::istringstream(contentOf(path("waiting"))) >> pid;
  ASSERT_FALSE(pid.empty());
  EXPECT_EQ(contentOf("/proc/" + pid + "/cmdline"), "") << "absent, or dead and not yet buried";
}

TEST_F(Working, TakesOverAClaimThatAPowerFailureLeftEmptyAndSaysSo) {
  const std::string sweep = sweepOf(2);
  writeFile(sweep + "/claims/000000.1", "");
  fs::last_write_time(sweep + "/claims/000000.1", fs::file_time_type::clock::now() - std::chrono::hours(1));
  std::string said;
  options_.say = [&](const std::string& message) { said += message + "\n"; };
  EXPECT_EQ(workWith(script(good_end), sweep).done_count, 2u);
  EXPECT_TRUE(contains(said, "row 0: taken over: " + sweep + "/claims/000000.1: is unreadable")) << said;
}

TEST_F(Working, FinishesWhatWasKilledBetweenTheOutputAndTheResult) {
  const std::string sweep = sweepOf(1);
  workWith(script("echo a >$2/file.txt; " + good_end), sweep);
  fs::remove(sweep + "/results/000000.json");
  fs::remove(sweep + "/claims/000000.1");
  EXPECT_EQ(workWith(script("echo a >$2/file.txt; " + good_end), sweep).done_count, 1u);
  EXPECT_EQ(contentOf(sweep + "/outputs/000000/file.txt"), "a\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(sweep + "/outputs"), {}), 1);
}

TEST_F(Working, RefusesASweepOfAnotherModelOrWithChangedInputs) {
  const std::string sweep = sweepOf(1), manifest = contentOf(sweep + "/manifest.json"), good = script(good_end);
  auto with = [&](const std::string& member, const std::string& value) {
    const auto at = manifest.find("\"" + member + "\": \"") + member.size() + 5;
    writeFile(sweep + "/manifest.json", std::string(manifest).replace(at, manifest.find('"', at) - at, value));
    return messageOf<BadFile>([&] { workWith(good, sweep); });
  };
  EXPECT_TRUE(contains(with("program", "musclesim 99"), "was planned by musclesim 99"));
  EXPECT_TRUE(contains(with("robots_hash", "0"), "with other robots than this program has"));

  Sweep second;
  writeFile(folder_ / "input.txt", "a");
  second.command = {"run", addInput(second, path("second"), path("input.txt"))};
  second.rows = {{}};
  writeSweep(second, path("second"));
  writeFile(path("second/inputs/000-input.txt"), "b");
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { workWith(good, path("second")); }), "has changed"));
}

TEST_F(Working, ReportsAFolderThatCannotBeWritten) {
  const std::string sweep = sweepOf(1);
  fs::remove(sweep + "/results");
  EXPECT_THROW(workWith(script(good_end), sweep), IoError);
}

TEST_F(Working, ProgramPlansWorksAndCollects) {
  writeFile(folder_ / "plan.toml",
            "format = \"musclesim-sweep-1\"\ncommand = [\"run\", \"--simple\", \"--robot\", \"rig\", \"--controller\", "
            "\"hold\", \"--duration\", \"0.05\", \"--out\", \"{out}\", \"--json\", \"--quiet\"]\n"
            "[grid]\nrig.load_kg = [1, 2, -5]\n");
  ASSERT_EQ(runProgram({"plan", "plan.toml", "-o", "runs"}, folder_).status, 0);
  EXPECT_EQ(runProgram({"plan", "plan.toml", "-o", "runs"}, folder_).status, 2) << "there is a sweep already";
  ProgramResult collected = runProgram({"collect", "runs"}, folder_);
  EXPECT_EQ(collected.status, 6);
  EXPECT_TRUE(contains(collected.out, "missing  3: rows 0 1 2"));
  EXPECT_EQ(runProgram({"work", "runs", "--time-limit", "-1"}, folder_).status, 2);
  EXPECT_EQ(runProgram({"work", "runs"}, folder_).status, 0);
  collected = runProgram({"collect", "runs"}, folder_);
  EXPECT_EQ(collected.status, 6);
  EXPECT_TRUE(contains(collected.out, "failed   1: rows 2"));
  EXPECT_TRUE(contains(readResult(path("runs"), 2).message, "rig.load_kg = -5 kg"));
  EXPECT_EQ(readResult(path("runs"), 1).numbers["log"], "outputs/000001/run.csv");
  EXPECT_TRUE(fs::exists(folder_ / "runs/outputs/000001/run.csv"));
  EXPECT_EQ(runProgram({"work", "nowhere"}, folder_).status, 5);
}

TEST_F(Working, ProgramGivesItsRowBackWhenItIsTerminated) {
  writeFile(folder_ / "plan.toml",
            "format = \"musclesim-sweep-1\"\ncommand = [\"run\", \"--simple\", \"--robot\", \"rig\", \"--controller\", "
            "\"hold\", \"--duration\", \"1e6\", \"--out\", \"{out}\", \"--json\", \"--quiet\"]\n");
  ASSERT_EQ(runProgram({"plan", "plan.toml", "-o", "runs"}, folder_).status, 0);
  const ProgramResult worker = interruptProgram({"work", "runs"}, SIGTERM, "runs/claims/000000.1", 1, folder_);
  EXPECT_EQ(worker.status, 143) << worker.err;
  EXPECT_TRUE(contains(contentOf(path("runs/claims/000000.1.end")), "abandoned"));
  EXPECT_TRUE(fs::is_empty(path("runs/workers")));
  EXPECT_TRUE(fs::is_empty(path("runs/outputs")));
}

}  // namespace
}  // namespace musclesim
