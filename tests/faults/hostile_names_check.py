#!/usr/bin/env python3
"""Gives robots, recordings, folders, descriptions and columns hostile names: markup, quotes, right-to-left and control characters, ten
thousand characters. Figures must be well-formed XML without anything that runs, JSON and CSV must be read again with the same names, the
report must contain no element of the names, and a terminal must get no control characters.

    hostile_names_check.py [PROGRAM]      default: build/release/musclesim
"""

import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import xml.sax.saxutils

root = pathlib.Path(__file__).resolve().parents[2]
program = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/musclesim").resolve()

markup = "<img src=x onerror=alert(1)>\"'&amp;]]><script>alert(2)</script><!--"
right_to_left = "\u202egnorw\u202c \u05d0\u05d1 \u0627\u0628"
control = "bell\x07 escape\x1b[31m\x1b]0;title\x07 tab\t return\r\n line \x00 end".replace("\x00", "")
names = {
    "markup": markup,
    "right to left": right_to_left,
    "control": control,
    "long": "A" + "x\u00e9" * 5000,
    "formula": "=cmd|' /C calc'!A0, \"a\",\"b\";${x}$(touch hostile)`touch hostile`",
}
urdf = ('<robot name=NAME><link name="a"/><link name=NAME><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
        'ixy="0" ixz="0" iyz="0"/></inertial></link><joint name=NAME type="continuous"><parent link="a"/><child link=NAME/>'
        '<axis xyz="1 0 0"/></joint></robot>')
failures = []
scripts = set()  # numbers of scripts in reports
count = 0


def expect(condition, what):
    global count
    count += 1
    if not condition:
        failures.append(what)
        print(what, flush=True)


def run(*arguments, allowed=(0,)):
    result = subprocess.run([str(program), *arguments], capture_output=True, timeout=300, check=False)
    text = (result.stdout + result.stderr).decode(errors="replace")
    shown = " ".join(arguments)[:80].encode("unicode_escape").decode()
    expect(result.returncode in allowed, "%s ended with %d: %s" % (shown, result.returncode, text[:300].encode("unicode_escape").decode()))
    bad = [c for c in text if (ord(c) < 32 and c not in "\n\t") or 0x7F <= ord(c) < 0xA0]
    expect(not bad, "%s: a terminal gets %s" % (shown, sorted(set(bad))))
    return text


class Elements(html.parser.HTMLParser):
    """Collects elements and attributes of a page."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found += [tag] + [name for name, _ in attributes]


def requireSvg(file, name):
    text = pathlib.Path(file).read_bytes()
    try:
        tree = xml.etree.ElementTree.fromstring(text)
    except xml.etree.ElementTree.ParseError as error:
        return expect(False, "%s: %s is not well-formed: %s" % (name, file[-40:], error))
    parts = [element.tag.split("}")[-1] for element in tree.iter()] + [key for element in tree.iter() for key in element.attrib]
    bad = [part for part in parts if part in ("script", "img", "foreignObject", "image") or part.lower().startswith("on")]
    expect(not bad, "%s: the figure has %s" % (name, bad))
    return None


def requireReport(file, name):
    found = Elements(pathlib.Path(file).read_text(encoding="utf-8")).found
    bad = [part for part in found if part == "img" or part.startswith("on")]
    expect(not bad, "%s: the report has %s" % (name, bad))
    scripts.add(found.count("script"))
    expect(len(scripts) == 1, "%s: the report has another number of scripts than that of other names" % name)


def describe(csv, **members):
    file = pathlib.Path(csv).with_suffix(".json")
    sidecar = json.loads(file.read_text())
    sidecar.update(members)
    file.write_text(json.dumps(sidecar))


def checkDescriptions():
    """Texts of a sidecar go through replay, figure and import of what was written."""
    for name, text in names.items():
        run("--simple", "--quiet", "--robot", "elbow", "--duration", "0.3", "--record", "rec.csv")
        describe("rec.csv", description=text, trial=text, program="musclesim " + text, repeat_of=text, **{text[:200]: text})
        run("figure", "rec.csv", "-o", "figure.svg")
        requireSvg("figure.svg", "description: " + name)
        run("figure", "rec.csv", "-o", "title.svg", "--title", text.replace("\x00", ""))
        requireSvg("title.svg", "title: " + name)
        run("replay", "rec.csv", "--out", "sim.csv", "--json")
        requireSvg("sim.svg", "replay: " + name)
        again = json.loads(pathlib.Path("sim.json").read_text())
        expect(again["description"] == text and again["trial"] == text, "description: %s is not kept" % name)
        run("rerun", "rec.csv", "--json")


def checkPaths():
    """Names of folders and files, as long as a file system takes them."""
    for name, text in {**names, "no UTF-8": os.fsdecode(b"a\xff\xfeb")}.items():
        folder = text.replace("/", "|")[:80]
        while len(os.fsencode(folder)) > 200:
            folder = folder[:-1]
        made = run("--simple", "--robot", "elbow", "--duration", "0.3", "--out", folder, "--json")
        log = json.loads(made[made.index('{"command"'):].splitlines()[0])["log"]
        expect(log == os.fsencode(folder).decode(errors="replace") + "/run.csv", "path: %s is not that in JSON" % name)
        requireSvg(folder + "/run.svg", "path: " + name)
        run("replay", folder + "/run.csv", "--out", folder + "/again.csv", "--json")
        requireSvg(folder + "/again.svg", "path: " + name)
        run("rerun", folder)
        run("replay", folder + "/absent.csv", allowed=(5,))
    expect(not os.path.exists("hostile"), "a name was run by a shell")


def checkRobots():
    """Robots named by their file, or by a name in it; bodies and joints."""
    run("robot", "new", "lever")
    lever = pathlib.Path("lever.toml").read_text()
    for name, text in names.items():
        quoted = json.dumps(text)
        for old in ('name = "lever"', 'format = "musclesim-robot-1"'):
            pathlib.Path("named.toml").write_text(lever.replace(old, old + ("\nname = " + quoted if old[0] == "f" else ""), 1))
        run("robot", "check", "named.toml", allowed=(0, 3))
        file = (text.replace("/", "|")[:60]) + ".toml"
        pathlib.Path(file).write_text(lever)
        run("robot", "check", file, allowed=(0, 3))
        run("--simple", "--robot", file, "--duration", "0.2", "--out", "robot", "--overwrite", allowed=(0, 2, 3))
        xml_text = xml.sax.saxutils.quoteattr(re.sub("[\x00-\x08\x0b-\x1f]", "?", text))
        pathlib.Path("r.urdf").write_text(urdf.replace("NAME", xml_text))
        pathlib.Path("r.toml").unlink(missing_ok=True)
        run("robot", "import", "r.urdf", "-o", "r.toml")
        run("robot", "check", "r.toml")


def checkLongNames():
    """Ten thousand letters, which a robot's or a joint's name may have, in columns, labels and the title of the window."""
    long_name = "A" * 10_000
    text = pathlib.Path("lever.toml").read_text().replace('name = "lever"', 'name = "%s"' % long_name)
    pathlib.Path("long.toml").write_text(text)
    run("--simple", "--robot", "long.toml", "--duration", "0.3", "--out", "long")
    requireSvg("long/run.svg", "a long robot's name")
    run("rerun", "long")
    run("replay", "long/run.csv", "--out", "long/again.csv")
    shown = run("--robot", "long.toml", "--duration", "0.1", "--screenshot", "long.png", "--out", "drawn", allowed=(0, 2, 5))
    expect(os.path.exists("long.png") or "OSMesa" in shown or "cannot draw" in shown, "a long name: no picture: " + shown[:200])
    if shutil.which("xvfb-run"):
        result = subprocess.run(["xvfb-run", "-a", str(program), "--robot", "long.toml", "--duration", "1", "--out", "window"],
                                capture_output=True, timeout=120, check=False)
        expect(result.returncode == 0 or b"built without" in result.stderr, "a long name: the window ended with %d" % result.returncode)


def checkColumns():
    """Columns of tables of other programs, of recordings, and unknown ones."""
    for name, text in names.items():
        cell = text.replace('"', '""').replace("\n", " ").replace("\r", " ")
        pathlib.Path("log.csv").write_text('"t","%s",b\n0,0.1,0.2\n1,0.3,0.4\n' % cell, newline="\n")
        run("import", "--look", "log.csv", allowed=(0, 3))
        mapping = 'robot = "elbow"\n[columns]\ntime_s = "t"\ncommand_0 = %s\ncommand_1 = "nothing"\n'
        pathlib.Path("map.toml").write_text(mapping % json.dumps(text))
        run("import", "log.csv", "map.toml", "out.csv", "--overwrite", allowed=(3,))
        table = "time_s,command_0,command_1,angle_%s_deg\n0,0,0,0\n1,0,0,0\n" % text.replace(",", ";")
        pathlib.Path("bad.csv").write_text(table, newline="\n")
        pathlib.Path("bad.json").write_text('{"format": "musclesim-recording-1", "robot": "elbow"}')
        run("replay", "bad.csv", "--out", "bad_sim.csv", allowed=(0, 3))
        run("figure", "bad.csv", "--signals", "angle*", "-o", "bad.svg", allowed=(0, 2, 3))
        if os.path.exists("bad.svg"):
            requireSvg("bad.svg", "column: " + name)


def checkReport():
    for name, text in names.items():
        folder = "d" + text.replace("/", "|")[:40]
        os.makedirs(folder, exist_ok=True)
        bench = ["--robot", "spring_bench", "--controller", "triangle", "--muscle", "line", "--duration", "1"]
        run("--simple", "--quiet", *bench, "--record", folder + "/r.csv")
        describe(folder + "/r.csv", description=text, trial=text)
        run("diagnose", folder + "/r.csv", "--out", folder + "/out", "--quiet")
        pages = list(pathlib.Path(folder).glob("out/*.html"))
        expect(pages, "%s: there is no report" % name)
        for page in pages:
            requireReport(page, name)
        for figure in pathlib.Path(folder).glob("out/**/*.svg"):
            requireSvg(str(figure), "report: " + name)
        for data in pathlib.Path(folder).glob("out/*.json"):
            json.loads(data.read_text())


def main():
    with tempfile.TemporaryDirectory(prefix="musclesim_names_") as folder:
        os.chdir(folder)
        for check in (checkDescriptions, checkPaths, checkRobots, checkLongNames, checkColumns, checkReport):
            check()
        os.chdir("/")
    print("%d checks of hostile names, %d failed" % (count, len(failures)))
    sys.exit(1 if failures else 0)


main()
