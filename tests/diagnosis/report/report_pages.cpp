// Writes the pages that report_browser_test.py opens: report_pages FOLDER.
#include <cstdio>
#include <filesystem>

#include "../sample_diagnosis.h"
#include "musclesim/base/file.h"

namespace musclesim {
namespace {

Diagnosis unexplained() {
  Diagnosis d = sampleDiagnosis();
  d.verdict = Verdict::unexplained;
  d.attempt = {{"leak@muscle_0"}, {{"leak", "muscle_0", {{"leak_per_s", 2.5}}}}, d.after, 40, 30, 50};
  d.chosen.clear();
  d.removal.clear();
  d.none_of_these = 0.8;
  return d;
}

Diagnosis noGap() {
  Diagnosis d;
  d.robot = "rig";
  d.recordings = {"slow.csv", "fast.csv"};
  d.before.per_signal["length_0_mm"] = {0.1, 0.1};
  d.traces = {sampleTrace("length_0_mm", 1001, 10, false)};
  d.not_excited = {"leak@muscle_0"};
  return d;
}

/// As many signals and rows as a large machine has.
Diagnosis large() {
  Diagnosis d = sampleDiagnosis();
  for (int muscle = 2; muscle < 42; ++muscle) addSampleSignal(d, "length_" + std::to_string(muscle) + "_mm", 20001, 10);
  return d;
}

/// Markup, quotes, right-to-left and control characters, and ten thousand letters, in everything that comes from files and arguments.
std::string hostileText() {
  return "<script>hostile = 1</script><img src=x onerror=hostile=1>\"'&amp;]]><!-- \u202egnorw\u202c \x1b[31m\x07 " +
         std::string(10'000, 'x');
}

Diagnosis hostile() {
  Diagnosis d = sampleDiagnosis();
  d.robot = hostileText();
  d.recordings = {hostileText() + ".csv", "b" + hostileText() + ".csv"};
  d.model_options = "--robot " + hostileText();
  d.held_out = hostileText();
  d.notes.push_back(hostileText());
  for (Trace& trace : d.traces) trace.recording = d.recordings.front();
  return d;
}

void writePages(const std::filesystem::path& folder) {
  const ReportOrigin origin{"2026-01-02 03:04",
                            "musclesim diagnose slow.csv fast.csv --out a-folder-with-a-name-that-is-too-long-for-a-phone"};
  std::filesystem::create_directories(folder);
  replaceFile((folder / "found.html").string(), diagnosisReport(sampleDiagnosis(), origin));
  replaceFile((folder / "unexplained.html").string(), diagnosisReport(unexplained(), origin));
  replaceFile((folder / "no_gap.html").string(), diagnosisReport(noGap(), origin));
  replaceFile((folder / "large.html").string(), diagnosisReport(large(), origin));
  replaceFile((folder / "hostile.html").string(), diagnosisReport(hostile(), {"2026-01-02 03:04", "musclesim diagnose " + hostileText()}));
}

}  // namespace
}  // namespace musclesim

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fprintf(stderr, "usage: report_pages FOLDER\n");
    return 2;
  }
  musclesim::writePages(arguments[1]);
}
