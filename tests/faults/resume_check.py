#!/usr/bin/env python3
"""Kills diagnoses with SIGKILL at random instants and goes on with --resume, each up to ten times, until one ends by itself. The answer must
be that of an undisturbed diagnosis, byte for byte but for the time it took, its date and its command line, in diagnosis.json, the report,
effects.json and the proposed recording.

    resume_check.py [PROGRAM] [DIAGNOSES = 10]      default: build/release/musclesim; SEED=N: other instants
"""

import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[2]
program = str(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/musclesim").resolve())
count = int(sys.argv[2]) if len(sys.argv) > 2 else 10
most_kills = 10
instants = random.Random(int(os.environ.get("SEED", "1")))
effects = ('{"format": "musclesim-effects-1", "effects": [{"id": "payload", "component": "hand", "parameters": {"mass_kg": 0.4}}, '
           '{"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.06, "vent_time_constant_s": 0.06}}]}')
differs = re.compile(r'"wall_s": [0-9.e+-]+|took \d+ s on the clock|\d{4}-\d\d-\d\d \d\d:\d\d|musclesim diagnose [^<]*')


def ran(*arguments):
    result = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit("resume_check: %s ended with %d: %s" % (" ".join(arguments), result.returncode, result.stderr))


def answer(folder):
    return {file.name: differs.sub("", file.read_text()) for file in pathlib.Path(folder).iterdir()}


def main():
    pathlib.Path("effects.json").write_text(effects)
    for name, seed in (("a", "1"), ("b", "2")):
        ran("--simple", "--quiet", "--robot", "rig", "--muscle", "line", "--controller", "prbs", "--duration", "3", "--seed", seed,
            "--set", "sensor.length_noise_mm=0.05",
            "--effects", "effects.json", "--record", name + ".csv")
    diagnose = ["diagnose", "a.csv", "b.csv", "--without-active-effects", "--candidates", "payload,valve_lag,force_gain,creep", "--tune",
                "rig.load_kg", "--max-effects", "2", "--jobs", "2"]
    start = time.monotonic()
    ran(*diagnose, "--out", "whole", "--quiet")
    whole_s = time.monotonic() - start
    reference = answer("whole")
    kills, wrong, kept_bytes, resumed = 0, 0, 0, 0
    for i in range(count):
        folder, kept = "cut%d" % i, pathlib.Path("cut%d/unfinished.dat" % i)
        for attempt in range(most_kills + 1):
            process = subprocess.Popen([program, *diagnose, "--out", folder, *(["--resume"] if attempt else [])],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            try:
                limit_s = instants.uniform(0.02, 0.7) * whole_s if attempt < most_kills else None
                said = process.communicate(timeout=limit_s)[1]
                resumed += "goes on from" in said
                break
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                kills += 1
                kept_bytes = max(kept_bytes, kept.stat().st_size if kept.exists() else 0)
        if process.returncode != 0 or answer(folder) != reference:
            wrong += 1
            print("WRONG: %s ended with %d, differs in %s: %s" % (folder, process.returncode, [
                name for name in {**reference, **answer(folder)} if answer(folder).get(name) != reference.get(name)], said))
    print("%d diagnoses killed %d times at random instants; %d of them went on from what was kept (%.1f MB at most); answers that are not "
          "those of an undisturbed diagnosis: %d" % (count, kills, resumed, 1e-6 * kept_bytes, wrong))
    return 1 if wrong or not kills else 0


with tempfile.TemporaryDirectory(prefix="musclesim_resume_check_") as work:
    os.chdir(work)
    result = main()
    os.chdir("/")
sys.exit(result)
