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

You have a muscle on a bench, a logger that writes tables, and a simulation that does not do what the machine does. This page goes from the tables to a simulation that does. So that you can follow it without a machine, the program plays the machine, too.

## 1. The measurements

The machine of this tutorial is a `spring_bench`, a muscle against a spring. Two things about it are not what the simulation's user thinks: its valve lags, and its spring is stiffer than the drawing says.

TEXT
file machine.json json <<'TEXT'
{"format": "musclesim-effects-1", "effects": [
  {"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.06, "vent_time_constant_s": 0.12}}]}
TEXT
text <<'TEXT'

Four runs with random steps of pressure, and a logger with columns, units and a zero of its own:

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

A mapping says what the columns are, which robot this is, and how noisy the sensors are. The noise is the standard deviation of a reading while nothing moves, in the unit of the name: `pressure_0` is a fraction of full scale, `pressure_0_bar = 0.018` would say the same. [Recordings](recordings.md#tables-of-other-programs) has all that a mapping can say.

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

A robot of your own is a subclass of `Robot` that is built into the program; see [A robot of your own](own_robot.md#registering). `spring_bench`, `wrist`, `rig`, `elbow` and `arm` come with the program, and `[robot_parameters]` sets their numbers.

## 3. The gap

TEXT
show 'musclesim replay bench1.csv'
text <<'TEXT'

The length is off by forty times the noise. Where does that come from?

## 4. The diagnosis

Nobody measured the spring, so `--tune` names it. Two recordings are for fitting, the last one only measures the result (of a real machine it should differ more from them than here); the fourth stays in the drawer.

TEXT
show 'musclesim diagnose bench1.csv bench2.csv bench3.csv --tune spring_bench.spring_N_per_mm --out answer'
text <<'TEXT'

Read it from the top:

- *where*: the stage. Here measured pressures tell: the model driven by them in place of its own shows the gap of the length too, so it arises before the force. Whether the command came late or the pressure did is told by the gap's shape alone.
- *which*: the effects with their probabilities; "none of these" is one of the answers.
- *how far*: on `bench3.csv`, which neither fitting nor choosing has seen. The nominal refit is what the simulation's own numbers could have gained without any effect, the sham what a meaningless disturbance gains.

`answer/report.html` shows the same with the curves; drag over one to zoom. [Diagnosing](diagnosing.md) explains what each number means and when not to believe it.

## 5. The better simulation

`effects.json` and `nominal.toml` are what was learnt:

TEXT
show 'cat answer/effects.json answer/nominal.toml'
text <<'TEXT'

On the recording from the drawer:

TEXT
show 'musclesim replay bench4.csv'
show 'musclesim replay bench4.csv --config answer/nominal.toml --effects answer/effects.json'
text <<'TEXT'

What is left is the noise. Every run takes the two files, also with a controller:

TEXT
show 'musclesim --simple --quiet --robot spring_bench --muscle line --controller random --duration 2 --config answer/nominal.toml --effects answer/effects.json --record better.csv | head -1'
text <<'TEXT'

## When it is not that easy

Real machines have several causes at once, laws that no catalogue follows to the letter, and data with faults of their own. The [case studies](../research/case_studies.md) show what is left then and what to do:

- `--max-effects 3` looks for more effects, one beside the other; `--effects answer/effects.json --config answer/nominal.toml` gives what was found to the next diagnosis.
- A gap that grows with time need not be a muscle that creeps or drifts. If readings fall ever further behind the commands, a clock is slow: look at the curves in the report before you believe a number.
- A fault of a sensor that you know, take out in the mapping (`offset`, `factor`).
- "I cannot explain" with a probability is an answer. `attempt.json`, where there is one, holds what comes nearest.

[Recording data that can be diagnosed](recordings.md#recording-data-that-can-be-diagnosed) saves most of the trouble.
TEXT
cp "$page" "$root/docs/user/tutorial_diagnosis.md"
chmod 644 "$root/docs/user/tutorial_diagnosis.md"
echo "docs/user/tutorial_diagnosis.md" >&2
