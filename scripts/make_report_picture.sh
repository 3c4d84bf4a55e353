#!/usr/bin/env bash
# Makes docs/user/figures/report.png, the picture of a diagnosis in README.md and docs/user/diagnosing.md. The machine that is diagnosed is
# an elbow whose valves are slow, simulated with sensor noise. A minute.
#
#     scripts/make_report_picture.sh [build folder]   (default: build/release)
#
# Needs chromium.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
program=$(readlink -f "${1:-$root/build/release}/musclesim")
[[ -x $program ]] || { echo "make_report_picture.sh: there is no program $program; build it first" >&2; exit 1; }
command -v chromium >/dev/null || { echo "make_report_picture.sh: chromium is not installed" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >machine.json <<'TEXT'
{"format": "musclesim-effects-1", "effects": [
  {"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.05, "vent_time_constant_s": 0.12}}]}
TEXT
# commands SEED: antagonistic steps, small enough to keep the elbow off its stops.
commands() {
  python3 - "$1" <<'PYTHON'
import random, sys
random.seed(int(sys.argv[1]))
print("time_s,command_0,command_1")
difference = 0
for row in range(801):
    if row and row % 50 == 0: difference = random.uniform(-0.05, 0.05)
    print(f"{row / 100},{0.45 + difference:.4f},{0.45 - difference:.4f}")
PYTHON
}
sidecar='{"format": "musclesim-recording-1", "robot": "elbow", "robot_parameters": {"muscle.model": "line"}}'
for run in 1 2 3; do
  commands "$run" >"command$run.csv"
  echo "$sidecar" >"command$run.json"
  "$program" replay "command$run.csv" --effects machine.json --seed "$run" --out "run$run.csv" --quiet \
    --set sensor.pressure_noise_ratio=0.003 --set sensor.force_noise_N=0.5 --set sensor.length_noise_mm=0.05 \
    --set sensor.angle_noise_deg=0.05 --set sensor.hand_noise_mm=0.2 >/dev/null
  echo "$sidecar" >"run$run.json"  # a real machine's sidecar does not say what acts on it
done
"$program" diagnose run1.csv run2.csv run3.csv --out answer
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --force-device-scale-factor=1 --window-size=1000,770 \
  --screenshot=report.png "file://$work/answer/report.html" 2>/dev/null
install -m 644 report.png "$root/docs/user/figures/report.png"
echo "docs/user/figures/report.png" >&2
