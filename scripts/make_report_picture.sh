#!/usr/bin/env bash
# Makes docs/user/figures/report.png and report_curves.png, the pictures of a diagnosis in README.md and docs/user/diagnosing.md. The machine
# that is diagnosed is an elbow whose commands come late and whose valves are slow, simulated with sensor noise. A minute.
#
#     scripts/make_report_picture.sh [build folder]   (default: build/release)
#
# Needs chromium, chromium-driver and python3-selenium.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
program=$(readlink -f "${1:-$root/build/release}/musclesim")
[[ -x $program ]] || { echo "make_report_picture.sh: there is no program $program; build it first" >&2; exit 1; }
python=/usr/bin/python3  # of Debian, which has Selenium
for tool in chromium chromedriver; do
  command -v "$tool" >/dev/null || { echo "make_report_picture.sh: $tool is not installed" >&2; exit 1; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >machine.json <<'TEXT'
{"format": "musclesim-effects-1", "effects": [
  {"id": "transport_delay", "component": "all", "parameters": {"delay_s": 0.03}},
  {"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.05, "vent_time_constant_s": 0.12}}]}
TEXT
# commands SEED: large steps of both muscles together, and antagonistic steps small enough to keep the elbow off its stops.
commands() {
  python3 - "$1" <<'PYTHON'
import random, sys
random.seed(int(sys.argv[1]))
print("time_s,command_0,command_1")
both, difference = 0.45, 0
for row in range(801):
    if row and row % 50 == 0: both, difference = random.uniform(0.3, 0.6), random.uniform(-0.03, 0.03)
    print(f"{row / 100},{both + difference:.4f},{both - difference:.4f}")
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
"$python" - <<'PYTHON'
import base64, os
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

options = webdriver.ChromeOptions()
options.binary_location = "/usr/bin/chromium"
for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1000,800"):
    options.add_argument(argument)
driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
driver.get("file://" + os.path.abspath("answer/report.html"))

def picture(name, first, last):
    """The page from one element to the end of another."""
    top, bottom = driver.execute_script(
        "const box = s => document.querySelector(s).getBoundingClientRect(); return [box(arguments[0]).top - 8, box(arguments[1]).bottom + 8]", first, last)
    clip = {"x": 0, "y": top, "width": 1000, "height": bottom - top, "scale": 1}
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
    with open(name, "wb") as file:
        file.write(base64.b64decode(shot["data"]))

picture("report.png", "h1", ".place")
picture("report_curves.png", "figure.trace", "figure.trace")
driver.quit()
PYTHON
for picture in report report_curves; do
  install -m 644 "$picture.png" "$root/docs/user/figures/$picture.png"
  echo "docs/user/figures/$picture.png" >&2
done
