#!/usr/bin/env bash
# Runs the checks behind docs/developer/reliability.md and writes it.
#
#     scripts/make_reliability_docs.sh [ROW ...]       default: all that need no fresh machine; DATE of the last run stands in each row
#
# A command that ends with status 77 could not try what it should: "not tried". The last result of every row is kept in docs/research/reliability/ROW.txt: how it ended, when, and what its command printed. Rows that are not named
# keep theirs. Uses build/release and, for the parsers, build/fuzz. BUILD=folder chooses another build.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
cd "$root"
build=${BUILD:-build/release}

# name|what is promised|command
rows=(
  "parsers|the readers of recordings (CSV, sidecar), parameters (TOML), effects, sweep plans and manifests and the command line under libFuzzer with both sanitizers: no crash, no hang, errors name their place|scripts/fuzz.sh 60"
  "parsers_of_files|the readers of tables, robots (own, URDF, MJCF, SDF, built), mappings, MATLAB files, schedules, targets, static points and the origin of a run under libFuzzer with both sanitizers, 1e6 executions each or as many as three minutes on one processor have (the lines tell which are short; a release needs 1e6)|env RUNS=1000000 scripts/fuzz.sh 180 foreign_table robot_toml mapping_toml matlab commands_csv targets_csv static_points robot_urdf robot_mjcf robot_sdf robot_built run_origin"
  "parsers_to_a_million|a million executions each of the readers of effects, sidecars, sweep plans and manifests, parameters, robots (own), mappings and the origin of a run under libFuzzer with both sanitizers|env RUNS=1000000 scripts/fuzz.sh 0 effects_json sidecar_json sweep_plan sweep_manifest configuration_toml robot_toml mapping_toml run_origin"
  "altered|altered and cut variants of the kept corpus through all targets, 10 s each, without sanitizers and without a view of what is reached|env MUSCLESIM_LONG_TESTS=1 $build/tests/fuzz/fuzz_tests --gtest_filter=*Altered*"
  "corpus|the kept corpus, and altered and cut variants of it, through the same targets|$build/tests/fuzz/fuzz_tests"
  "outputs|a fault in everything that the program writes (runs, diagnoses, replays, figures, imports, fits, robot files, reruns, sweeps, blind checks, pictures, the window's recordings): full and read-only disks, failing system calls, SIGKILL at random instants, a clock set back by a day: what stands under its final name is whole or marked as not complete; exit status 5 with a message, or 0 and all files|tests/faults/output_check.py $build/musclesim"
  "resume|diagnoses killed at random instants, again and again, go on with --resume to the bytes of an undisturbed diagnosis; also from damaged files, and what does not fit is refused by name|tests/faults/resume_check.py $build/musclesim 6"
  "numbers|NaN, infinities, 1e308, -0 and denormals at every muscle's pressure, in forces, in every parameter of effects and robots, in every column of a recording: refused or Diverged within a step|$build/tests/reliability/reliability_tests --gtest_filter=NonFinite.*"
  "divergence|non-finite, far, fast and torn bodies end the run with time, place and cause; the next simulation is as if nothing had been|$build/tests/robot/robot_tests --gtest_filter=*AFault*"
  "random_robots|2,000 robots of random calls x 200 steps and 500 with an impossible number: done, diverged or refused, no signal|env MUSCLESIM_LONG_TESTS=1 $build/tests/reliability/reliability_tests --gtest_filter=RandomRobots.*"
  "kill|SIGKILL while logging at 200 random instants: readable, at most 256 rows or 1 s lost, never complete|env MUSCLESIM_LONG_TESTS=1 $build/tests/log/log_tests --gtest_filter=Recorder.Killed*"
  "disk|full and read-only disks, full standard output, failing system calls: exit status 5, never complete|tests/faults/disk_check.sh $build/musclesim"
  "signals|SIGINT and SIGTERM: ends within a step + 0.5 s, files complete, 130/143|tests/faults/signal_check.sh $build/musclesim"
  "determinism|100 repeats, on one thread and beside another: the same state hashes every 100 steps|env MUSCLESIM_LONG_TESTS=1 $build/tests/reliability/reliability_tests --gtest_filter=*Determinism*"
  "physics|momentum, energy, periods and static pulls against closed forms|$build/tests/analytic/analytic_tests"
  "second_engine|sixteen robots in MuJoCo, read from the robots themselves: passive falls, equilibria that stay, energy, reversed time; closed forms of the rig and of a pendulum|$build/tests/bench/second_engine_study"
  "hostile|files made to do harm (nesting, a million bodies, circles of includes, decompression bombs, devices and holes without end, names and links that lead out of a folder), for robot files, URDF, SDF, MJCF, recordings and sidecars, schedules, effects, configurations, mappings, tables, MATLAB files and plugins: a message, the right exit status, and at most a second of processor time and 500 MB of memory each|tests/faults/hostile_check.py $build/musclesim"
  "names|markup, quotes, right-to-left and control characters, bytes that are no UTF-8 and ten thousand letters as names of robots, joints, bodies, columns, files and folders and as descriptions: figures are well-formed and contain nothing that runs, JSON and CSV keep the names, the report has no element of theirs, a terminal gets no control characters; the report in a browser: tests/diagnosis/report/report_browser_test.py|tests/faults/hostile_names_check.py $build/musclesim"
  "rerun|a run is repeated from its folder alone, moved and without its input files: the same bytes, or the names of what differs; also after divergence, SIGINT and SIGKILL, and for sessions by hand; reads no file but the copies|$build/tests/src/program_tests --gtest_filter=RerunCommand.*"
  "soak|1e6 steps: memory grows by less than 1 MB, open files not at all|$build/tests/bench/soak_study"
  "work|random work (runs, replays, diagnoses, sweeps, reruns; ensembles, steps and diagnoses in one long process of Python; a window with random keys): the same bytes whenever work is drawn again; memory and open files of long processes do not grow; a quarter of an hour here, eight hours for a release (--hours 8)|/usr/bin/python3 tests/reliability/soak.py --hours 0.25 --figure docs/developer/figures/soak.svg"
  "threads|ensembles, the store of predictions, a small diagnosis that is interrupted and resumed, and ensembles in Python under the thread sanitizer: no report|scripts/thread_check.sh"
  "sanitizers|the tests of files, basic parts and robots, without slow ones, under the address and undefined-behaviour sanitizers, compiled by clang; a release needs the whole suite (scripts/check.sh --sanitizers)|env PRESET=fuzz scripts/check.sh --sanitizers log base robot"
  "continuous_integration|the corpora and the short forms of the rows above that continuous integration runs with the other tests: together within five minutes|timeout 300 ctest --test-dir $build -R ^Of/FuzzCorpus|^faults|^reliability|^RerunCommand|^ResumedDiagnosis|^NonFinite|^RandomRobots|Determinism|^Recorder.Killed|AFault"
  "security|no network, no shell: what the program imports; the reader's limits|scripts/security_check.sh $build/musclesim"
  "sweep|500 runs on two workers, a tenth of the runs and one worker killed: the table of the undisturbed sweep|$build/tests/bench/sweep_study $build/musclesim 500"
  "parallel|a disturbed sweep under GNU parallel|tests/cluster/cluster_check.sh parallel $build/musclesim"
  "slurm|a disturbed sweep under Slurm, batch file of the documentation|tests/cluster/cluster_check.sh slurm $build/musclesim"
)

[[ -e $build/build.ninja ]] || { echo "make_reliability_docs: there is no build in $build; cmake --preset release makes one" >&2; exit 2; }
cmake --build "$build" --target musclesim fuzz_tests reliability_tests robot_tests log_tests analytic_tests soak_study sweep_study second_engine_study program_tests diagnose_tests musclesim_python >&2
mkdir -p docs/research/reliability
# passed_some: whether a test program's output (standard input) tells of at least one test that passed; a filter may match none.
passed_some() {
  grep -qaE '^\[  PASSED  \] [1-9][0-9]* tests?\.'
}

wanted=("$@")
status=0
for row in "${rows[@]}"; do
  IFS='|' read -r name _ command <<<"$row"
  if ((${#wanted[@]})) && [[ " ${wanted[*]} " != *" $name "* ]]; then continue; fi
  echo "$name: $command" >&2
  result=passed ended=0 start=$SECONDS
  # Words of a command are separated by spaces; none has any within.
  # shellcheck disable=SC2086
  output=$($command 2>&1) || ended=$?
  case $ended in
    0) ;;
    77) result="not tried" ;;
    *) result=FAILED ;;
  esac
  if [[ $result == passed && $command == *_tests* ]] && ! passed_some <<<"$output"; then
    result=FAILED
    output+=$'\nno test was run'
  fi
  [[ $result != FAILED ]] || status=1
  {
    echo "$result"
    date -u +%Y-%m-%d
    echo "$((SECONDS - start)) s"
    # Of a test program and of ctest the totals, failures and figures; of a script everything.
    if [[ $command == *_tests* ]]; then
      grep -aE '^\[ +(PASSED|FAILED)|tests? from .* ran|Failure$|^(valid|places|altered inputs): |^no test was run' <<<"$output"
    elif [[ $command == *ctest* || $command == *--sanitizers* ]]; then
      grep -aE '^[a-z]+: |tests passed|^Total Test time|\*\*\*|\((Failed|Timeout|Skipped|SEGFAULT)|^sanitizers' <<<"$output"
    else
      tail -n 25 <<<"$output"
    fi | cut -c1-300 | sed -e "s|$root/||g" || true
  } >"docs/research/reliability/$name.txt"
  echo "  $result" >&2
done

{
  cat <<'TEXT'
# Reliability

<!-- Made by scripts/make_reliability_docs.sh; do not edit. -->

The same binary, ODE build, input and seed give the same bits, whatever the number of threads. A failed run never looks like a good one. Each row below is a promise, the command that tries it, and its last result. `scripts/make_reliability_docs.sh ROW` tries a row again.

| row | promise | last result |
|---|---|---|
TEXT
  for row in "${rows[@]}"; do
    IFS='|' read -r name promise _ <<<"$row"
    file=docs/research/reliability/$name.txt
    if [[ -e $file ]]; then result="$(sed -n 1p "$file"), $(sed -n 2p "$file"), $(sed -n 3p "$file")"; else result="never run"; fi
    printf '| [%s](#%s) | %s | %s |\n' "$name" "$name" "$promise" "$result"
  done
  for row in "${rows[@]}"; do
    IFS='|' read -r name _ command <<<"$row"
    printf '\n## %s\n\n`%s`\n' "$name" "$command"
    if [[ -e docs/research/reliability/$name.txt ]]; then printf '\n```\n%s\n```\n' "$(tail -n +4 "docs/research/reliability/$name.txt")"; fi
    if [[ $name == work && -e docs/developer/figures/soak.svg ]]; then printf '\n![Memory of the processes over time](figures/soak.svg)\n'; fi
  done
  cat <<'TEXT'

## Not covered by a row above

- ODE, NumPy and Python are not instrumented for the thread sanitizer. One report was about ODE, which hands the place of a destroyed shape from thread to thread by an atomic exchange that the sanitizer cannot see; it is named in `scripts/thread_suppressions.txt`. Under this sanitizer the SIMD kernels are compiled for the plain processor only: versions per processor are chosen before the sanitizer is ready. Where a process has one processor, the test that two Python threads simulate at the same time is skipped. A sweep has no threads: its workers are processes.
- The window against a headless run: `tests/src` compares the recordings of runs with and without pictures.
- Second engines: contacts, springs, two-axis hinges and limits of balls are not compared. Why the row second_engine shows differences: musclesim's method is of the first order, which at steps of 0.1 ms leaves tenths of a millimetre, and most in a body that turns about three axes (pendulum on a ball). The rig's chain falls onto the stops of its links: those of MuJoCo are springs whose stiffness follows the light beads, so the heavy load drives them in (19 mm with its default impedance, 7 mm with the harder one of the table). A chain at rest hangs in a curve under the weight of its beads, while musclesim settles it along a straight line: that is the drift of chains. Lines, pulleys, hinges, sliders and universal joints agree to a thousandth of the way or better. [Performance](../reference/performance.md#other-engines) has the arm's chains, and the arm in Simbody, too.
- A release needs 1e6 executions per fuzz target (`RUNS=1000000 scripts/fuzz.sh 0`). Eight targets have them, in the row parsers_to_a_million. The other eleven are short of them, as the rows parsers (60 s each) and parsers_of_files (three minutes each on one processor, which builds and other checks shared) tell: recording_csv, command_line, foreign_table, robot_urdf, robot_mjcf, robot_built, static_points, commands_csv, targets_csv, robot_sdf and matlab. At the rates of these rows they need ten minutes to an hour and a quarter each, robot_sdf four hours and a half, and matlab two days.
- Two targets are slow. A short profile shows the copying of the process (MATLAB files are read in one of their own) and, for SDF, libsdformat reading its own description of the format for every file. Of the process that reads MATLAB files libFuzzer does not see which code is reached, so the inputs of this target do not improve; all files that made libmatio crash in it ask for more memory than the sanitizer gives.
- MATLAB files are read in a process of their own, so a crash of libmatio is an answer and no finding. With large files the memory allowed grows: 128 MB and 40 times the file.
- `tests/faults/output_check.py` needs root, fiu-utils and faketime (apt-get install fiu-utils faketime); it names what it could not try. Several files of one command are renamed one after the other; a process that is killed within these microseconds leaves some of an earlier answer beside those of the new one.
- `diagnose --resume` repeats the simulations of the next experiment, which are not kept. In the folder of a killed diagnosis `unfinished.dat` stays until the diagnosis is resumed or repeated.
- The whole suite under the address and undefined-behaviour sanitizers (`scripts/check.sh --sanitizers`): the row sanitizers has three folders of tests; the other folders, simulation and diagnosis among them, have not been run under them.
- The row sweep ran last on one processor that other work shared, so two workers were hardly faster than one; on two idle processors they had 98.5 % (2026-11-21).
- Eight hours of random work: the row work has a quarter of an hour.
- The Debian packages: `scripts/debian_package_check.sh DIR` installs them on a fresh Debian 12.
TEXT
} >docs/developer/reliability.md
echo "docs/developer/reliability.md" >&2
exit "$status"
