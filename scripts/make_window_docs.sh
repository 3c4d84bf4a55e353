#!/usr/bin/env bash
# Makes the pictures of docs/user/window.md, docs/user/figures/window*.png, and the table of its section "Measured".
# Usage: scripts/make_window_docs.sh [--pictures] [build folder]   (default: build/release)
# With --pictures the table stays. Needs Xvfb, xdotool and ffmpeg.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
only_pictures=
[[ "${1:-}" == --pictures ]] && { only_pictures=1; shift; }
build="${1:-build/release}"
program="$PWD/$build/musclesim"
figures="$PWD/docs/user/figures"
page="$PWD/docs/user/window.md"
[[ -x "$program" ]] || { echo "make_window_docs.sh: there is no program $program; build it first" >&2; exit 1; }
for tool in Xvfb xdotool ffmpeg ffprobe; do
  command -v "$tool" >/dev/null || { echo "make_window_docs.sh: $tool is not installed" >&2; exit 1; }
done

work=$(mktemp -d)
mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 1024x768x24 -noreset 3>"$work/number" 2>/dev/null &
server=$!
trap 'kill "$server"; rm -rf "$work"' EXIT
read -r number <"$work/number"
export DISPLAY=":$number"
cd "$work"

# window ARGUMENT...: opens one and waits until it has drawn.
window() {
  rm -rf log.jsonl run
  "$program" --out run --window-log log.jsonl --quiet "$@" >out.txt 2>&1 &
  child=$!
  until [[ -s log.jsonl ]]; do sleep 0.1; done
  xdotool mousemove 100 100
}
close_window() {
  xdotool key q
  wait "$child" || true
}
shot() { ffmpeg -v error -y -f x11grab -draw_mouse 0 -video_size 1024x768 -i "$DISPLAY" -frames:v 1 -pix_fmt rgb24 "$figures/$1"; }

window --seed 1
sleep 5
xdotool key 7
sleep 0.5
shot window.png
xdotool key h
sleep 1
shot window_help.png
xdotool key h t f
sleep 5
shot window_labels.png
close_window

window --robot elbow --controller random --decision-interval 0.05 --substeps 1 --step 0.05 --speed 100
until grep -q verdict run/run.json 2>/dev/null; do sleep 0.1; done
sleep 1
shot window_diverged.png
close_window

window --robot elbow --controller hold --camera 0,0,900
sleep 1
xdotool mousemove 357 540 keydown ctrl mousedown 1 keyup ctrl sleep 0.1 mousemove 400 540 sleep 0.1 mousemove 530 510 sleep 1.5
shot window_pull.png
xdotool mouseup 1
close_window

"$program" --robot elbow --controller hold --camera 0,0,900 --arrows --duration 1 --picture-size 512x512 --screenshot elbow.png --out elbow --quiet >/dev/null
window --picture-size 822x512 --camera=-60,8,750
xdotool key t a
sleep 5
xdotool key s
until [[ -s run/window-1.png ]]; do sleep 0.1; done
sleep 0.5
ffmpeg -v error -y -i elbow.png -i run/window-1.png -filter_complex hstack -frames:v 1 -pix_fmt rgb24 "$figures/window_arrows.png"
close_window

for robot in rig elbow; do
  rm -rf "$robot"
  "$program" --robot "$robot" --controller hold --duration 1 --plane --picture-size 800x600 --screenshot "$robot.png" --out "$robot" --quiet >/dev/null
done
ffmpeg -v error -y -i rig.png -i elbow.png -filter_complex hstack,scale=1024:-2 -frames:v 1 -pix_fmt rgb24 "$figures/window_rig_elbow.png"

begin=$(date +%s.%N)
"$program" --video arm.mp4 --duration 20 --out video --quiet >/dev/null
video_s=$(echo "$(date +%s.%N) - $begin" | bc)
frames=$(ffprobe -v error -show_entries stream=nb_frames -of csv=p=0 arm.mp4)
ffmpeg -v error -y -i arm.mp4 -vf "select='eq(mod(n-30,100),0)',crop=700:768:150:0,scale=350:-1,tile=6x1" -frames:v 1 "$figures/window_video.png"

[[ -n "$only_pictures" ]] && { echo "written: $figures/window*.png"; exit; }

# measure SECONDS ARGUMENT...: rate of pictures and pace in a window of 1024 x 768 with software rendering.
measure() {
  rm -f log.jsonl
  "$program" --duration "$1" "${@:2}" --window-log log.jsonl --out measured --overwrite --quiet --json | tail -1 >verdict.json
  python3 - <<'PYTHON'
import json
last = json.loads(open("log.jsonl").read().splitlines()[-1])
verdict = json.load(open("verdict.json"))
print(f'{last["frames_per_s"]:.1f} | {verdict["real_time_factor"]:.3f} | {"4" if last["smooth"] else "1"}')
PYTHON
}
# measure_replay: pictures per second of the replay of an arm, with the measured pose and the plots of a signal, over 10 s.
measure_replay() {
  rm -f log.jsonl
  "$program" --simple --quiet --duration 10 --record arm.csv --out arm --overwrite >/dev/null
  "$program" replay arm.csv --window --quiet --window-log log.jsonl --out sim.csv >/dev/null &
  local child=$!
  until [[ -s log.jsonl ]]; do sleep 0.1; done
  sleep 10
  xdotool mousemove 100 100 key q
  wait "$child" || true
  python3 - <<'PYTHON'
import json
last = json.loads(open("log.jsonl").read().splitlines()[-1])
assert last["replay"]["ghost"] and last["panel"]
print(f'{last["frames_per_s"]:.1f} | - | {"4" if last["smooth"] else "1"}')
PYTHON
}
{
  echo "A window of 1024 x 768 pixels with panel, 20 s of the height task, $(nproc) cores, drawn in software (llvmpipe under Xvfb, which needs processor time, too); load of the machine at the beginning: $(cut -d' ' -f1 /proc/loadavg), priority of these programs: nice $(nice)."
  echo
  echo "| run | pictures per second | simulated time / wall time | samples per pixel |"
  echo "|---|---|---|---|"
  echo "| arm, si, at real time | $(measure 20) |"
  echo "| arm, si, without panel, so that the scene fills the window | $(xdotool mousemove 100 100; (until [[ -s log.jsonl ]]; do sleep 0.1; done; xdotool key Tab) & sleep 0.2; measure 20) |"
  echo "| replay of the arm at real time, with the measured pose and plots | $(measure_replay) |"
  echo "| arm, original, at speed 10 | $(measure 100 --physics original) |"
  echo
  echo "The 20 s video of the height task without a display, 1024 x 768, $frames frames: $(printf '%.0f' "$video_s") s, ffmpeg included."
} >measured.txt
python3 - "$page" measured.txt <<'PYTHON'
import sys
page, text = (open(name).read() for name in sys.argv[1:])
begin, end = "<!-- window: written by scripts/make_window_docs.sh -->\n", "<!-- end of window -->"
head, rest = page.split(begin)
tail = rest.split(end)[1]
open(sys.argv[1], "w").write(head + begin + text + end + tail)
PYTHON
echo "written: $figures/window*.png, $page"
