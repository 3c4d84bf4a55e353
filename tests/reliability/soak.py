#!/usr/bin/env python3
"""Random work for hours: runs, replays, diagnoses, sweeps and ensembles, in the program and in one long process of Python, beside a window that
gets random keys. Looks at memory, open files and results: a piece of work that is drawn again must give the same bytes.

    soak.py [--hours H = 8] [--seed N = 1] [--program FILE] [--python FOLDER] [--figure FILE.svg] [--table FILE.csv]

--python: folder of the Python module (default: that of the program's build). Without the module, Xvfb or xdotool that part is left out, and
the last lines say so. Exit status 1 if a result changes, a piece of work or the window fails, or a long process grows: in the last half of
its life by more than 5 MB and 5 %, or by more than two open files.
"""

import argparse
import csv
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[2]
seeds_per_kind = 6  # so that work is drawn again and again
most_growth_MB, most_growth_share, most_more_files = 5, 0.05, 2
keys = "i p space Right 0 1 2 3 comma period plus minus r k b Home Up Down c t m a f v Tab h x Left".split()
line = ["--muscle", "line"]
volatile = re.compile(rb'"(wall_s|real_time_factor|processor)": [^,}\n]*')

# Runs in Python's process: one JSON line with a kind and a seed in, one with a hash or an error out.
worker = r"""
import gc, hashlib, json, sys
import musclesim, numpy as np
line = {"muscle.model": "line"}
def digest(*arrays):
    hashed = hashlib.sha256()
    for array in arrays: hashed.update(np.ascontiguousarray(array).tobytes())
    return hashed.hexdigest()
def steps(seed):
    draw = np.random.default_rng(seed)
    with musclesim.Simulation("elbow", parameters=line) as simulation:
        simulation.start([0.3, 0.3])
        return digest(*[simulation.step(draw.uniform(0, 0.8, 2), count=5).copy() for _ in range(100)])
def run(seed):
    return digest(*musclesim.run("elbow", lambda state: [0.4 + 0.01 * seed, 0.3], 2, parameters=line).to_dict().values())
def ensemble(seed):
    return digest(*musclesim.ensemble(lambda i: musclesim.run("rig", "prbs", 2, seed=i, parameters=line)["length_0_mm"], range(seed, seed + 4)))
def diagnose(seed):
    # Two recordings of a plant with 0.3 kg more load than the model knows.
    recordings = []
    for i in (2 * seed, 2 * seed + 1):
        made = musclesim.run("rig", "prbs", 2, seed=i, parameters={**line, "rig.load_kg": 2.3, "sensor.length_noise_mm": 0.05}).to_dict()
        columns = {name: made[name] for name in ("time_s", "command_0", "length_0_mm")}
        recordings.append(musclesim.Recording.from_dict(columns, robot="rig", noise_std={"length_0_mm": 0.05}))
    answer = musclesim.diagnose(recordings, parameters=line, candidates=["payload", "force_gain"], max_effects=1, seed=seed)
    data = dict(answer.data); data["cost"] = dict(data["cost"], wall_s=0)
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()
work = {"steps": steps, "run": run, "ensemble": ensemble, "diagnose": diagnose}
print(json.dumps({"ready": True}), flush=True)
for text in sys.stdin:
    kind, seed = json.loads(text)
    try: print(json.dumps({"hash": work[kind](seed)}), flush=True)
    except Exception as error: print(json.dumps({"error": repr(error)}), flush=True)
    gc.collect()
"""


class Watch:
    """Memory and open files of processes over time."""

    def __init__(self):
        self.start, self.rows = time.monotonic(), []

    def hours(self):
        return (time.monotonic() - self.start) / 3600

    def sample(self, name, life, pid):
        try:
            pages = int(pathlib.Path("/proc/%d/statm" % pid).read_text().split()[1])
            files = len(os.listdir("/proc/%d/fd" % pid))
        except OSError:
            return
        self.rows.append((self.hours(), name, life, pages * os.sysconf("SC_PAGE_SIZE") / 1e6, files))

    def lives(self):
        found = {}
        for hours, name, life, memory, files in self.rows:
            found.setdefault((name, life), []).append((hours, memory, files))
        return found

    def grown(self):
        """For every life of a process with enough samples: growth in its last half, MB and files, and whether that is too much."""
        for (name, life), rows in self.lives().items():
            if len(rows) < 20:
                continue
            half, tail = rows[len(rows) // 2:len(rows) * 5 // 8], rows[-len(rows) // 8:]
            memory = sum(r[1] for r in tail) / len(tail) - sum(r[1] for r in half) / len(half)
            files = max(r[2] for r in tail) - max(r[2] for r in half)
            too_much = memory > max(most_growth_MB, most_growth_share * half[0][1]) or files > most_more_files
            yield name, life, memory, files, too_much


class Soak:
    def __init__(self, options):
        self.program = str(pathlib.Path(options.program).resolve())
        self.python_folder = pathlib.Path(options.python or pathlib.Path(self.program).parent / "python").resolve()
        self.random = random.Random(options.seed)
        self.end = time.monotonic() + 3600 * options.hours
        self.watch, self.known, self.counts, self.failures, self.left_out = Watch(), {}, {}, [], []
        self.python = self.window = self.display = None
        self.life = 0

    def wrong(self, what):
        self.failures.append(what)
        print("WRONG:", what, flush=True)

    def note(self, kind, seed, hashed):
        self.counts[kind] = self.counts.get(kind, 0) + 1
        if self.known.setdefault((kind, seed), hashed) != hashed:
            self.wrong("%s of seed %d gave other bytes than before" % (kind, seed))

    # The program.
    def ran(self, *arguments, allowed=(0,)):
        process = subprocess.Popen([self.program, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        said = process.stderr.read()
        process.stderr.close()
        status, usage = os.wait4(process.pid, 0)[1:]
        process.returncode = os.waitstatus_to_exitcode(status)
        self.watch.rows.append((self.watch.hours(), "program", 0, usage.ru_maxrss / 1e3, 0))
        if process.returncode not in allowed:
            self.wrong("%s ended with %d: %s" % (" ".join(arguments)[:120], process.returncode, said.decode(errors="replace")[-300:]))

    def recorded(self, folder, seed, *more):
        os.makedirs(folder, exist_ok=True)
        self.ran("--simple", "--quiet", "--robot", "rig", "--controller", "prbs", "--duration", "2", "--seed", str(seed), *line, *more,
                 "--record", "%s/r%d.csv" % (folder, seed), "--overwrite")

    def hashOf(self, *files):
        hashed = hashlib.sha256()
        for file in files:
            hashed.update(volatile.sub(b"", pathlib.Path(file).read_bytes()))
        return hashed.hexdigest()

    def programRun(self, seed):
        robot = ("elbow", "rig", "wrist", "pulley_arm", "spring_bench", "arm")[seed % 6]
        model = line if robot == "arm" else []
        self.ran("--simple", "--quiet", "--robot", robot, "--controller", "random", "--duration", "2", "--seed", str(seed), *model,
                 "--out", "run", "--overwrite")
        self.ran("rerun", "run", "--quiet")
        return self.hashOf("run/run.csv")

    def programReplay(self, seed):
        self.recorded("replay", seed)
        self.ran("replay", "replay/r%d.csv" % seed, "--out", "replay/sim.csv", "--figure", "replay/gap.svg", "--quiet")
        return self.hashOf("replay/sim.csv", "replay/gap.svg")

    def programDiagnose(self, seed):
        for i in (2 * seed, 2 * seed + 1):
            self.recorded("diagnose", i, "--set", "rig.load_kg=2.3", "--set", "sensor.length_noise_mm=0.05")
            sidecar = pathlib.Path("diagnose/r%d.json" % i)
            sidecar.write_text(sidecar.read_text().replace('"load_kg": 2.3', '"load_kg": 2'))
        self.ran("diagnose", *("diagnose/r%d.csv" % i for i in (2 * seed, 2 * seed + 1)), "--candidates", "payload,force_gain",
                 "--max-effects", "1", "--out", "diagnose/out", "--quiet")
        return self.hashOf("diagnose/out/diagnosis.json", "diagnose/out/effects.json")

    def programSweep(self, seed):
        shutil.rmtree("runs", ignore_errors=True)
        pathlib.Path("sweep.toml").write_text(
            'format = "musclesim-sweep-1"\nseed = %d\ncommand = ["run", "--simple", "--robot", "rig", "--muscle", "line", '
            '"--controller", "hold", "--duration", "0.2", "--seed", "{seed}", "--out", "{out}", "--json", "--quiet"]\n'
            '[latin_hypercube]\ncount = 4\nrig.load_kg = {low = 1, high = 5}\n' % seed)
        self.ran("plan", "sweep.toml", "-o", "runs")
        self.ran("work", "runs", "--quiet")
        self.ran("collect", "runs")
        return self.hashOf("runs/collected.csv")

    # Python.
    def beginPython(self):
        if not list(self.python_folder.glob("musclesim/*.so")):
            self.left_out.append("Python (no module in %s)" % self.python_folder)
            return
        environment = {**os.environ, "PYTHONPATH": str(self.python_folder), "PYTHONDONTWRITEBYTECODE": "1"}
        self.python = subprocess.Popen([sys.executable, "-c", worker], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                       env=environment)
        if "ready" not in self.python.stdout.readline():
            self.wrong("Python did not begin")
            self.python = None

    def inPython(self, kind, seed):
        self.python.stdin.write(json.dumps([kind, seed]) + "\n")
        self.python.stdin.flush()
        answer = json.loads(self.python.stdout.readline() or '{"error": "the process ended"}')
        self.watch.sample("Python", 0, self.python.pid)
        if "error" in answer:
            self.wrong("Python, %s of seed %d: %s" % (kind, seed, answer["error"]))
            return None
        return answer["hash"]

    # The window.
    def beginWindow(self):
        if not shutil.which("Xvfb") or not shutil.which("xdotool"):
            self.left_out.append("window (Xvfb, xdotool)")
            return
        reading, writing = os.pipe()
        self.display = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1024x768x24", "-noreset"],
                                        pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.environ["DISPLAY"] = ":" + os.read(reading, 20).decode().strip()
        self.openWindow()

    def openWindow(self):
        self.life += 1
        shutil.rmtree("window", ignore_errors=True)
        robot = self.random.choice(("elbow", "arm", "wrist"))
        self.window = subprocess.Popen([self.program, "--robot", robot, *line, "--out", "window", "--quiet"], stdout=subprocess.DEVNULL,
                                       stderr=open("window.txt", "w", encoding="utf-8"))
        self.opened = time.monotonic()

    def pressKeys(self):
        words = []
        for _ in range(5):
            words += ["key", self.random.choice(keys), "mousemove", str(self.random.randrange(1000)), str(self.random.randrange(700)), "sleep",
                      "0.05"]
        subprocess.run(["xdotool", *words], capture_output=True, check=False)
        self.watch.sample("window", self.life, self.window.pid)
        self.counts["keys"] = self.counts.get("keys", 0) + 5
        if self.window.poll() is not None:
            self.endWindow()
            self.openWindow()

    def endWindow(self):
        for _ in range(60):
            if self.window.poll() is not None:
                break
            subprocess.run(["xdotool", "mousemove", "5", "5", "key", "Escape", "sleep", "0.2", "key", "q", "sleep", "0.8"],
                           capture_output=True, check=False)
        if self.window.poll() is None:
            self.window.kill()
            self.wrong("the window did not close")
        elif self.window.returncode not in (0, 4):  # 4: a run diverged because it was pulled at
            self.wrong("the window ended with %d: %s" % (self.window.returncode, pathlib.Path("window.txt").read_text()[-300:]))

    def work(self):
        kinds = {"run": self.programRun, "replay": self.programReplay, "diagnosis": self.programDiagnose, "sweep": self.programSweep}
        if self.python:
            kinds.update({"Python " + kind: lambda seed, kind=kind: self.inPython(kind, seed)
                          for kind in ("steps", "run", "ensemble", "diagnose")})
        while time.monotonic() < self.end:
            kind, seed = self.random.choice(list(kinds)), self.random.randrange(seeds_per_kind)
            hashed = kinds[kind](seed)
            if hashed:
                self.note(kind, seed, hashed)
            self.watch.sample("this script", 0, os.getpid())
            if self.window:
                self.pressKeys()

    def soak(self):
        self.beginPython()
        self.beginWindow()
        try:
            self.work()
            if self.window:
                self.endWindow()
        finally:
            for process in (self.window, self.display, self.python):
                if process and process.poll() is None:
                    process.terminate()


def ticks(most):
    """Round numbers from 0 to at most `most`, five to ten of them."""
    step = next(step for power in range(-4, 6) for step in (10.0**power, 2 * 10.0**power, 5 * 10.0**power) if most / step <= 8)
    return [step * i for i in range(int(most / step) + 1)]


def figure(watch):
    """The memory of every process over time, as SVG."""
    width, height, left, bottom, top = 760, 320, 60, 40, 20
    hours = max([row[0] for row in watch.rows] + [1e-6])
    most = 1.1 * max([row[3] for row in watch.rows] + [1])
    colors = {"program": "#999999", "Python": "#1f77b4", "window": "#d62728", "this script": "#2ca02c"}

    def at(hour, memory):
        return "%.1f,%.1f" % (left + (width - left - 130) * hour / hours, height - bottom - (height - bottom - top) * memory / most)

    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="12">' % (width, height),
             '<rect width="100%" height="100%" fill="white"/>']
    unit, name = (60, "min") if hours < 1 else (1, "h")
    for value in ticks(unit * hours):
        x = at(value / unit, 0).split(",")[0]
        parts.append('<text x="%s" y="%d" text-anchor="middle">%g</text>' % (x, height - bottom + 18, value))
    for value in ticks(most):
        y = at(0, value).split(",")[1]
        parts.append('<text x="%d" y="%s" text-anchor="end" dy="4">%g</text>' % (left - 6, y, value))
        parts.append('<line x1="%d" x2="%d" y1="%s" y2="%s" stroke="#ddd"/>' % (left, width - 130, y, y))
    parts.append('<text x="%d" y="%d" text-anchor="middle">time, %s</text>' % ((left + width - 130) / 2, height - 6, name))
    parts.append('<text transform="translate(14,%d) rotate(-90)" text-anchor="middle">resident memory, MB</text>' % (height / 2))
    for (process, _), rows in watch.lives().items():
        color = colors[process]
        if process == "program":  # one point per process: its largest memory
            parts += ['<circle cx="%s" cy="%s" r="1.5" fill="%s"/>' % (*at(hour, memory).split(","), color) for hour, memory, _ in rows]
        else:
            parts.append('<polyline fill="none" stroke="%s" points="%s"/>' % (color, " ".join(at(h, m) for h, m, _ in rows)))
    for i, (process, color) in enumerate(colors.items()):
        label = "program (peaks)" if process == "program" else process
        parts.append('<text x="%d" y="%d" fill="%s">%s</text>' % (width - 126, top + 16 * (i + 1), color, label))
    return "\n".join(parts + ["</svg>\n"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--hours", type=float, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", default=str(root / "build/release/musclesim"))
    parser.add_argument("--python")
    parser.add_argument("--figure")
    parser.add_argument("--table")
    options = parser.parse_args()
    home = os.getcwd()
    soak = Soak(options)
    with tempfile.TemporaryDirectory(prefix="musclesim_soak_") as work:
        os.chdir(work)
        soak.soak()
        os.chdir(home)
    repeated = sum(soak.counts.values()) - soak.counts.get("keys", 0) - len(soak.known)
    print("%.2f h, seed %d: %s; %d results were compared with earlier ones" %
          (soak.watch.hours(), options.seed, ", ".join("%d %s" % (n, kind) for kind, n in sorted(soak.counts.items())), repeated))
    for name, life, memory, files, too_much in soak.watch.grown():
        if name == "program":
            continue
        print("%s %d: %+.1f MB and %+d open files in the last half of its life" % (name, life, memory, files))
        if too_much:
            soak.wrong("%s %d grows" % (name, life))
    if soak.left_out:
        print("left out:", ", ".join(soak.left_out))
    print("not as it should be:", len(soak.failures))
    if options.figure:
        pathlib.Path(options.figure).write_text(figure(soak.watch), encoding="utf-8")
    if options.table:
        with open(options.table, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([("hours", "process", "life", "memory_MB", "open_files"), *soak.watch.rows])
    return 1 if soak.failures else 0


sys.exit(main())
