#!/usr/bin/env bash
# Makes the pictures of replays in docs/user/figures: replay_gap.svg, window_replay.png and the video window_replay.mp4, of an elbow and a
# rig whose valves lag.
# Usage: scripts/make_replay_docs.sh [musclesim]   (the program; default: build/release/musclesim)
# Needs Xvfb, xdotool, ffmpeg and python3.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=$(readlink -f "${1:-build/release/musclesim}")
[[ -x "$program" ]] || { echo "make_replay_docs.sh: there is no program $program; build it first or name it" >&2; exit 1; }
for tool in Xvfb xdotool ffmpeg python3; do
  command -v "$tool" >/dev/null || { echo "make_replay_docs.sh: $tool is not installed" >&2; exit 1; }
done
figures=$PWD/docs/user/figures
work=$(mktemp -d)
mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 1024x768x24 -noreset -nolisten tcp 3>"$work/number" 2>/dev/null &
server=$!
trap 'kill "$server"; rm -rf "$work"' EXIT
read -r number <"$work/number"
export DISPLAY=":$number"
cd "$work"

cat >lag.json <<'JSON'
{"format": "musclesim-effects-1", "effects": [{"id": "valve_lag", "component": "all",
  "parameters": {"fill_time_constant_s": 0.15, "vent_time_constant_s": 0.25}}]}
JSON
record() { # ROBOT: a recording with the lag and with noise, as of a machine
  "$program" --simple --robot "$1" --controller triangle --duration 8 --effects lag.json --record "$1.csv" --out record --quiet >/dev/null
  python3 - "$1" <<'PYTHON'
import csv, json, random, sys
robot = sys.argv[1]
sidecar = json.load(open(f"{robot}.json"))
del sidecar["active_effects"]
json.dump(sidecar, open(f"{robot}.json", "w"))
random.seed(1)
noise = {"pressure": 0.002, "force": 0.1, "length": 0.3, "angle": 0.3, "hand": 1}
rows = list(csv.DictReader(open(f"{robot}.csv")))
for row in rows:
    for name in row:
        row[name] = float(row[name]) + random.gauss(0, noise.get(name.split("_")[0], 0))
table = csv.DictWriter(open(f"{robot}.csv", "w"), rows[0])
table.writeheader()
table.writerows(rows)
PYTHON
}
record rig
record elbow
"$program" replay rig.csv --figure "$figures/replay_gap.svg" --quiet >/dev/null

"$program" replay elbow.csv --window --effects lag.json --camera 0,0,900 --window-log log.jsonl --quiet >out.txt 2>&1 &
window=$!
until [[ -s log.jsonl ]]; do sleep 0.1; done
grab() { ffmpeg -v error -y -f x11grab -draw_mouse 0 -framerate 15 -video_size 1024x768 "$@"; }
go_to() { # X: clicks on the time line and takes the pointer away
  xdotool mousemove "$1" 749 click 1
  xdotool mousemove 650 20
}
go_to 60
grab -t 12 -i "$DISPLAY" -vf scale=768:-2 -codec:v libx264 -crf 28 -pix_fmt yuv420p -movflags +faststart "$figures/window_replay.mp4" &
film=$!
for _ in 1 2 3 4 5; do
  sleep 2
  xdotool key e
done
wait "$film"
xdotool key p
go_to 292
for picture in without with; do
  sleep 5  # until the notice has gone
  grab -i "$DISPLAY" -frames:v 1 "$picture.png"
  xdotool key e
done
xdotool key q
wait "$window"
ffmpeg -v error -y -i without.png -i with.png -filter_complex hstack,scale=1536:-2 -frames:v 1 "$figures/window_replay.png"
echo "written: $figures/replay_gap.svg, $figures/window_replay.png, $figures/window_replay.mp4"
