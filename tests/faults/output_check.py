#!/usr/bin/env python3
"""Faults in everything that the program writes: full and read-only disks, failing system calls, SIGKILL at random instants, a clock that is
set back. Each command first runs undisturbed; this is its reference. After a fault, a file under its final name must be that of the
reference, byte for byte but for times, or a recording that says that it is not complete; exit status 0 needs all files, exit status 5 a
message, and nothing else may happen.

    output_check.py [PROGRAM] [COMMAND ...]      default: build/release/musclesim, all commands; SHORT=1: fewer faults; SEED=N: other instants

Needs root for disks (a private mount namespace), fiu-run (fiu-utils) for failing calls, faketime for the clock, Xvfb for the window. What
cannot be tried is named; the exit status is then 77 if all else passes.
"""

import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[2]
program = str(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/musclesim").resolve())
chosen = sys.argv[2:]
short = bool(os.environ.get("SHORT"))
if os.geteuid() == 0 and os.environ.get("MUSCLESIM_PRIVATE_MOUNTS") != "yes":
    os.environ["MUSCLESIM_PRIVATE_MOUNTS"] = "yes"
    os.execvp("unshare", ["unshare", "--mount", "--propagation", "private", sys.executable, __file__, program, *chosen])

instants = random.Random(int(os.environ.get("SEED", "1")))
out = pathlib.Path("out")  # where every command writes
time_limit_s = 300
failures, untried = [], set()

sweep = """format = "musclesim-sweep-1"
command = ["run", "--simple", "--robot", "spring_bench", "--muscle", "line", "--controller", "hold", "--duration", "{duration}",
           "--seed", "{seed}", "--out", "{out}", "--json", "--quiet"]
[grid]
duration = [0.1, 0.2]
"""
mapping = 'robot = "rig"\n[columns]\ntime_s = "t"\ncommand_0 = "u"\nlength_0_mm = "y"\n'
urdf = """<robot name="lever"><link name="base"/><link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0"
ixz="0" iyz="0"/></inertial></link><joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="1 0 0"/>
</joint></robot>"""
few = ["--candidates", "force_gain,payload", "--max-effects", "1", "--jobs", "2", "--quiet"]
bench = ["--simple", "--quiet", "--robot", "spring_bench", "--muscle", "line"]

# name: arguments, and a folder of inputs that is copied to `out` before, or None
commands = {
    "run": (["--simple", "--robot", "rig", "--controller", "hold", "--duration", "1", "--quiet", "--out", "out/run"], None),
    "schedule": (["--simple", "--quiet", "--robot", "rig", "--commands", "in/a.csv", "--record", "out/r.csv", "--duration", "0.5"], None),
    "diagnose": (["diagnose", "in/a.csv", "in/b.csv", "--out", "out", "--json", "out/copy.json", "--tune", "rig.load_kg", *few], None),
    "replay": (["replay", "in/a.csv", "--out", "out/sim.csv", "--figure", "out/gap.svg", "--quiet"], None),
    "figure": (["figure", "in/a.csv", "-o", "out/figure.svg"], None),
    "import": (["import", "in/table.csv", "in/map.toml", "out/table.csv", "--quiet"], None),
    "look": (["import", "--look", "in/table.csv", "-o", "out/map.toml"], None),
    "fit": (["fit", "in/points.csv", "--law", "braun", "--out", "out/fit", "--quiet"], None),
    "experiment": (["experiment", "--specimen", "short", "--out", "out/frame", "--quiet"], None),
    "robot_new": (["robot", "new", "lever", "-o", "out/lever.toml"], None),
    "robot_export": (["robot", "export", "pulley_arm", "-o", "out/arm.toml"], None),
    "robot_import": (["robot", "import", "in/lever.urdf", "-o", "out/lever.toml"], None),
    "rerun": (["rerun", "in/run", "--out", "out/again", "--quiet"], None),
    "plan": (["plan", "in/sweep.toml", "-o", "out/runs"], None),
    "work": (["work", "out/runs", "--quiet", "--no-wait"], "planned"),
    "collect": (["collect", "out/runs"], "worked"),
    "blind_make": (["blind", "make", "out/cases", "--keys", "out/a/b/keys", "--count", "1", "--arm-count", "0", "--duration-s", "1", "--quiet"],
                   None),
    "blind_run": (["blind", "run", "out/cases", "--candidates", "payload", "--jobs", "1", "--quiet"], "made"),
    "blind_score": (["blind", "score", "out/cases", "--keys", "KEY", "--docs", "out/docs"], "answered"),
    "picture": (["--robot", "elbow", "--duration", "0.2", "--screenshot", "out/p.png", "--out", "out/run", "--quiet"], None),
    "window": (["--robot", "elbow", "--duration", "0.3", "--out", "out/run", "--quiet"], None),
}
# What a sweep holds while it goes on, of which `collect` takes only what has a result; temporary names; kept simulations.
volatile = re.compile(r"(claims|workers|outputs|results)/|\.tmp$|unfinished\.dat$")
drawn = re.compile(r"keys/|seal\.json$|answers\.json$")  # holds random numbers or times by design: must be whole JSON
# Times and places; a processor that could not be asked for its name.
times = [re.compile(text) for text in (rb'"(wall_s|child_wall_s|real_time_factor|started|finished|host|worker|pid|seconds)": ?[^,}\n]*',
                                       rb"\d{4}-\d\d-\d\d[ T]\d\d:\d\d(:\d\d)?", rb"took \d+ s on the clock", rb'"commit": ?"[^"]*"')]


def wrong(what):
    failures.append(what)
    print("WRONG:", what, flush=True)


def content(file):
    data = file.read_bytes()
    if drawn.search(str(file)):
        try:
            json.loads(data)
            return b"whole"
        except ValueError:
            return data
    for pattern in times:
        data = pattern.sub(b"", data)
    return data


def files():
    return {str(file.relative_to(out)): content(file) for file in sorted(out.rglob("*")) if file.is_file() and
            not volatile.search(str(file.relative_to(out)))}


def isUnfinished(name):
    """Whether it is a part of a recording that does not claim to be complete, or is refused because its sidecar is missing. A sidecar is
    written first, so it stands alone where its table could not be opened."""
    sidecar = (out / name).with_suffix(".json")
    if name.endswith(".csv"):
        return not sidecar.exists() or b'"complete": false' in sidecar.read_bytes()
    return name.endswith(".json") and b'"complete": false' in (out / name).read_bytes()


def clear():
    for entry in out.iterdir():
        if entry.is_dir():
            shutil.rmtree(entry)
        else:
            entry.unlink()


def fill(folder):
    if folder:
        shutil.copytree(folder, out, dirs_exist_ok=True)


def run(arguments, before=(), environment=None, kill_after_s=None):
    """Exit status, and what the command said on standard error; the status is that of a killed process if it was killed."""
    arguments = [str(next(pathlib.Path("in/keys").glob("*.json"))) if word == "KEY" else word for word in arguments]
    process = subprocess.Popen([*before, program, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               env={**os.environ, **(environment or {})})
    try:
        said = process.communicate(timeout=kill_after_s if kill_after_s is not None else time_limit_s)[1]
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        said = process.communicate()[1]
        if kill_after_s is None:
            wrong("%s took longer than %d s" % (arguments[0], time_limit_s))
    return process.returncode, said.decode(errors="replace").strip()


def judge(what, reference, status, said, statuses=(0, 5)):
    if status not in statuses:
        wrong("%s: exit status %d: %s" % (what, status, said[-300:]))
    if status == 5 and not said:
        wrong("%s: exit status 5 without a message" % what)
    found = files()
    for name, data in found.items():
        is_draft = drawn.search(name) and data == b"whole"
        if reference.get(name) != data and not is_draft and not isUnfinished(name):
            wrong("%s: %s (%d bytes) is neither whole nor marked" % (what, name, len(data)))
    if status == 0:
        for name in reference:
            if name not in found and not drawn.search(name):
                wrong("%s: exit status 0, but no %s" % (what, name))
    return status


class Disk:
    """A tmpfs on `out`."""

    def __init__(self, size_KiB, read_only=False):
        self.options = ("size=%dk" % size_KiB) + (",ro" if read_only else "")

    def __enter__(self):
        subprocess.run(["mount", "-t", "tmpfs", "-o", self.options, "tmpfs", str(out)], check=True)

    def __exit__(self, *_):
        subprocess.run(["umount", str(out)], check=True)


def fullDisks(name, arguments, folder, reference):
    used_KiB = sum(4 * (1 + len(data) // 4096) for data in reference.values()) + 4
    full = 0
    for share in (0.3, 0.9) if short else (0, 0.15, 0.3, 0.5, 0.7, 0.8, 0.9, 1.0):
        with Disk(max(4, int(share * used_KiB))):
            try:
                fill(folder)
            except OSError:
                continue  # not even the inputs fit
            status, said = run(arguments)
            full += judge("%s, disk of %.0f %%" % (name, 100 * share), reference, status, said) == 5
    with Disk(used_KiB * 3 + 4096):  # with room for new versions beside the old ones
        fill(folder)
        judge("%s, disk with room" % name, reference, *run(arguments), statuses=(0,))
    return full


def readOnly(name, arguments, folder, reference):
    with Disk(used := 65536):
        fill(folder)
        subprocess.run(["mount", "-o", "remount,ro", str(out)], check=True)
        before = files()
        status, said = run(arguments)
        if status != 5 or not said:
            wrong("%s, read-only disk: exit status %d: %s" % (name, status, said))
        if files() != before:
            wrong("%s, read-only disk of %d KiB changed" % (name, used))


def failingCalls(name, arguments, folder, reference):
    fives = 0
    for call in ("rw/write", "sync/fsync", "dir/rename", "oc/close", "oc/open"):
        for nth in (3,) if short else (1, 2, 3, 5, 8, 13):
            clear()
            fill(folder)
            fault = "enable_random name=posix/io/%s,probability=%g" % (call, 1 / nth)
            status, said = run(arguments, before=["fiu-run", "-x", "-c", fault])
            fives += judge("%s, %s fails once in %d" % (name, call, nth), reference, status, said) == 5
        if name == "work":
            requireSameTable("work, %s fails" % call)
    return fives


def requireSameTable(what):
    """A disturbed sweep, worked on once more, has the table of an undisturbed one."""
    ok(commands["work"][0])
    ok(commands["collect"][0])
    if (out / "runs/collected.csv").read_bytes() != pathlib.Path("collected.csv").read_bytes():
        wrong(what + ": the sweep, worked on once more, has another table")


def kills(name, arguments, folder, reference, whole_s):
    for i in range(2 if short else 8):
        clear()
        fill(folder)
        # Half of the instants are near the end, when most commands write.
        share = instants.uniform(0, 1) if i % 2 else instants.uniform(0.8, 1.02)
        judge("%s, killed after %.0f %%" % (name, 100 * share), reference, *run(arguments, kill_after_s=max(0.002, share * whole_s)),
              statuses=(0, -signal.SIGKILL))
        if name == "work":
            requireSameTable("work, killed")


def clockSetBack(name, arguments, folder, reference):
    clear()
    fill(folder)
    stamp = pathlib.Path("stamp")
    stamp.write_text("+0\n")
    environment = {"FAKETIME_TIMESTAMP_FILE": str(stamp.resolve()), "FAKETIME_NO_CACHE": "1", "DONT_FAKE_MONOTONIC": "1",
                   "LD_PRELOAD": fake_clock}
    pid = os.fork()
    if pid == 0:  # sets the clock back by a day while the command runs
        time.sleep(0.05)
        stamp.write_text("-86400\n")
        os._exit(0)
    judge("%s, clock set back" % name, reference, *run(arguments, environment=environment), statuses=(0,))
    os.waitpid(pid, 0)


def prepare():
    pathlib.Path("in").mkdir()
    out.mkdir()
    pathlib.Path("in/table.csv").write_text("t,u,y\n" + "".join("%.2f,%g,%g\n" % (0.01 * i, 0.3 if i < 40 else 0.5, 240 - 0.2 * i)
                                                                 for i in range(100)))
    pathlib.Path("in/map.toml").write_text(mapping)
    pathlib.Path("in/lever.urdf").write_text(urdf)
    pathlib.Path("in/sweep.toml").write_text(sweep)
    points = "pressure,length_mm,force_N\n"
    for pressure in (0.2, 0.4, 0.6, 0.8, 1.0):
        for length in range(110, 210, 10):
            points += "%g,%d,%g\n" % (pressure, length, max(0, pressure * (length - 100) * 2 + length % 7))
    pathlib.Path("in/points.csv").write_text(points)
    for name, seed in (("a", "1"), ("b", "2")):
        ok(["--simple", "--quiet", "--robot", "rig", "--muscle", "line", "--controller", "prbs", "--duration", "1", "--seed", seed,
            "--set", "sensor.length_noise_mm=0.05",
            "--set", "rig.load_kg=2.3", "--record", "in/%s.csv" % name])
        sidecar = pathlib.Path("in/%s.json" % name)
        sidecar.write_text(sidecar.read_text().replace('"load_kg": 2.3', '"load_kg": 2'))
    ok(["--simple", "--quiet", "--robot", "rig", "--controller", "hold", "--duration", "0.5", "--out", "in/run"])
    for before, target, arguments in ((None, "planned", commands["plan"][0]), ("planned", "worked", commands["work"][0]),
                                      (None, "made", commands["blind_make"][0]), ("made", "answered", commands["blind_run"][0])):
        clear()
        fill(before)
        ok(arguments)
        shutil.copytree(out, target)
    shutil.copytree("made/a/b/keys", "in/keys")
    clear()
    fill("worked")
    ok(commands["collect"][0])
    shutil.copy(out / "runs/collected.csv", "collected.csv")


def ok(arguments):
    status, said = run(arguments)
    if status != 0:
        sys.exit("output_check: %s ended with %d: %s" % (" ".join(arguments), status, said))


def check(name, arguments, folder):
    clear()
    fill(folder)
    start = time.monotonic()
    status, said = run(arguments)
    whole_s = time.monotonic() - start
    if status == 2 and "built without" in said:
        untried.add(name)
        return
    reference = files()
    if status != 0 or not reference:
        wrong("%s, undisturbed: exit status %d: %s" % (name, status, said))
        return
    words = ["%d files" % len(reference)]
    kills(name, arguments, folder, reference, whole_s)
    clear()
    if os.geteuid() == 0:
        words.append("full disk: %d of %d ended with 5" % (fullDisks(name, arguments, folder, reference), 2 if short else 8))
        readOnly(name, arguments, folder, reference)
    if shutil.which("fiu-run"):
        words.append("failing calls: %d of %d" % (failingCalls(name, arguments, folder, reference), 5 if short else 30))
    if fake_clock:
        clockSetBack(name, arguments, folder, reference)
    print("%-13s %s" % (name, "; ".join(words)), flush=True)


def main():
    os.chdir(work)
    prepare()
    if os.geteuid() != 0:
        untried.add("full and read-only disks (root)")
    if not shutil.which("fiu-run"):
        untried.add("failing calls (fiu-utils)")
    if not fake_clock:
        untried.add("a clock set back (faketime)")
    display = None
    if shutil.which("Xvfb"):
        reading, writing = os.pipe()
        display = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "800x600x24"], pass_fds=[writing],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.environ["DISPLAY"] = ":" + os.read(reading, 20).decode().strip()
    else:
        untried.add("window (Xvfb)")
        commands.pop("window")
    try:
        for name, (arguments, folder) in commands.items():
            if not chosen or name in chosen:
                check(name, arguments, folder)
    finally:
        if display:
            display.terminate()
    print("faults in what %d commands write: %d not as they should be" % (len(chosen) or len(commands), len(failures)))
    if untried:
        print("NOT TRIED: " + ", ".join(sorted(untried)))


fake_clock = next((str(file) for file in pathlib.Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1")), "")
work = tempfile.mkdtemp(prefix="musclesim_output_check_")
try:
    main()
finally:
    os.chdir("/")
    shutil.rmtree(work, ignore_errors=True)
sys.exit(1 if failures else 77 if untried else 0)
