#!/usr/bin/env bash
# Runs every command of the diagnosis tutorial and writes docs/user/tutorial_diagnosis.md with what they printed.
#
#     scripts/make_tutorial_docs.sh [build folder]
#
# The "machine" of the tutorial is a simulation with an effect and a number that its user does not know. Half a minute.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
build=$(readlink -f "${1:-$root/build/release}")
[[ -x $build/musclesim ]] || { echo "make_tutorial_docs.sh: there is no program $build/musclesim; build it first" >&2; exit 1; }
PATH=$build:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
page=$work/tutorial_diagnosis.md

text() { cat >>"$page"; }
# show COMMAND: runs it and writes command and output.
show() {
  { echo '```'; echo "$1"; eval "$1" 2>/dev/null; echo '```'; } >>"$page"
}
# file NAME LANGUAGE: writes standard input to a file and onto the page.
file() {
  cat >"$1"
  { echo "\`$1\`:"; echo; echo "\`\`\`$2"; cat "$1"; echo '```'; } >>"$page"
}

text <<'TEXT'
# Tutorial: from a table of measurements to a better simulation

<!-- Made by scripts/make_tutorial_docs.sh, which ran every command; do not edit. -->

You have a muscle on a bench, a logger that writes tables, and a simulation that does not do what the machine does. This page leads from the tables to a simulation that moves like the machine:

```
musclesim import logger1.csv bench.toml bench1.csv                                                     # a table becomes a recording
musclesim diagnose bench1.csv bench2.csv bench3.csv --tune spring_bench.spring_N_per_mm --out answer   # why does the machine differ?
musclesim replay bench4.csv --config answer/nominal.toml --effects answer/effects.json                 # the better simulation
```

![The top of a report](figures/report.png)

You can follow it without a machine: the program simulates the machine, too.

## 1. The measurements

The machine of this tutorial is a `spring_bench`, a muscle against a spring. Its user does not know three things: commands reach the valve late, the valve lags, and the spring is stiffer than the drawing says.

TEXT
file machine.json json <<'TEXT'
{"format": "musclesim-effects-1", "effects": [
  {"id": "transport_delay", "component": "all", "parameters": {"delay_s": 0.025}},
  {"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.04, "vent_time_constant_s": 0.07}}]}
TEXT
text <<'TEXT'

Make four runs with random steps of pressure. The logger has its own columns, units and zero:

```
for run in 1 2 3 4; do
  musclesim --simple --quiet --robot spring_bench --muscle line --controller random --decision-interval 0.4 --duration 8 --seed $run \
    --effects machine.json --set spring_bench.spring_N_per_mm=6.5 \
    --set sensor.length_noise_mm=0.05 --set sensor.pressure_noise_ratio=0.003 --record run$run.csv
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; print "t,valve,p,stroke"; next }
    { printf "%.3f,%.4f,%.4f,%.3f\n", $c["time_s"], 10 * $c["command_0"], 6 * $c["pressure_0"], 250 - $c["length_0_mm"] }' run$run.csv >logger$run.csv
done
```

From here on only the logger's tables are used:

TEXT
for run in 1 2 3 4; do
  musclesim --simple --quiet --robot spring_bench --muscle line --controller random --decision-interval 0.4 --duration 8 --seed $run \
    --effects machine.json --set spring_bench.spring_N_per_mm=6.5 \
    --set sensor.length_noise_mm=0.05 --set sensor.pressure_noise_ratio=0.003 --record run$run.csv --out log >/dev/null
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; print "t,valve,p,stroke"; next }
    { printf "%.3f,%.4f,%.4f,%.3f\n", $c["time_s"], 10 * $c["command_0"], 6 * $c["pressure_0"], 250 - $c["length_0_mm"] }' run$run.csv >logger$run.csv
done
show 'head -4 logger1.csv'
text <<'TEXT'

## 2. Recordings

A mapping says what the columns are, which robot this is, and how noisy the sensors are. The noise is the standard deviation of a reading while nothing moves, in the unit of the name: `pressure_0` is a fraction of full scale; `pressure_0_bar = 0.018` is equivalent. [Recordings](recordings.md#tables-of-other-programs) explains mappings.

TEXT
file bench.toml toml <<'TEXT'
robot = "spring_bench"
pressure_full_scale_kPa = 600   # pressure 1 of the simulation
command_full_scale_V = 10       # command 1

[columns]
time_s = "t"
command_0_V = "valve"
pressure_0_bar = "p"
length_0_mm = { from = "stroke", factor = -1, offset = 250 }   # the logger counts how much shorter the muscle is

[noise_std]
length_0_mm = 0.05
pressure_0 = 0.003

[robot_parameters.muscle]
model = "line"
TEXT
text <<'TEXT'

TEXT
show 'for run in 1 2 3 4; do musclesim import logger$run.csv bench.toml bench$run.csv --quiet; done'
text <<'TEXT'

A robot of your own is a text file; see [A robot of your own](own_robot.md). `spring_bench`, `wrist`, `rig`, `elbow`, `pulley_arm` and `arm` come with the program, and `[robot_parameters]` sets their numbers.

## 3. The gap

TEXT
show 'musclesim replay bench1.csv'
text <<'TEXT'

The length is off by forty times the noise. Why?

## 4. The diagnosis

Nobody measured the spring, so `--tune` names it. The program fits the first two recordings (`bench1`, `bench2`) and uses the third one (`bench3`) only to measure the result. (With a real machine, this last recording should differ more from the others than it does here.) We keep the fourth recording for section 5.

TEXT
show 'musclesim diagnose bench1.csv bench2.csv bench3.csv --tune spring_bench.spring_N_per_mm --out answer'
text <<'TEXT'

Read it from the top:

- *tuned*: how many numbers of `--tune` were fitted. `nominal.toml` also holds the numbers of this robot that have a [tolerance](diagnosing.md#numbers-that-nobody-measured): force constant, friction, carriage, load.
- *where*: the stage at which the gap arises. If the model is given the measured pressures instead of the commands, it reproduces the measured length; so the gap arises before the force. Only the shape of the gap can then tell whether it arises in command or in pressure.
- *which*: the effects with their probabilities, and their parameters with 95 % intervals. "None of these" is a possible answer. Here two effects act together, and their numbers are those of `machine.json`.
- *how far*: the gap reduction on `bench3.csv`, which neither fitting nor choosing has seen. "Nominal refit" is the reduction that the model's own numbers achieve without any effect. "Negative control" is the reduction that a meaningless disturbance achieves.

`answer/report.html` shows the same with curves; drag over one to zoom. [Diagnosing](diagnosing.md) explains each number and when not to believe it.

## 5. The better simulation

`effects.json` and `nominal.toml` hold the result:

TEXT
show 'cat answer/effects.json answer/nominal.toml'
text <<'TEXT'

Try them on the fourth recording:

TEXT
show 'musclesim replay bench4.csv'
show 'musclesim replay bench4.csv --config answer/nominal.toml --effects answer/effects.json'
text <<'TEXT'

Only the noise remains. Every run accepts the two files, also with a controller:

TEXT
show 'musclesim --simple --quiet --robot spring_bench --muscle line --controller random --duration 2 --config answer/nominal.toml --effects answer/effects.json --record better.csv | head -1'
text <<'TEXT'

## When it is not that easy

Real machines have several causes at once, laws that differ from any catalogue's, and faulty data. The [case studies](../research/case_studies.md) show how much of the gap then remains and what to do:

- Up to four effects are looked for at once. `--effects answer/effects.json --config answer/nominal.toml` begins the next diagnosis with what this one found.
- A gap that grows with time may have another cause than creep or drift. If readings lag more and more behind the commands, a clock is slow: look at the curves in the report before you believe a number.
- Correct known faults of a sensor in the mapping (`offset`, `factor`).
- "I cannot explain" with a probability is an answer, too. `attempt.json`, if there is one, holds the nearest explanation.

Read [Recording data that can be diagnosed](recordings.md#recording-data-that-can-be-diagnosed) before you record.
TEXT
cp "$page" "$root/docs/user/tutorial_diagnosis.md"
chmod 644 "$root/docs/user/tutorial_diagnosis.md"
echo "docs/user/tutorial_diagnosis.md" >&2
