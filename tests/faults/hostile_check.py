#!/usr/bin/env python3
"""Gives the program hostile files: bombs, endless nesting, loops, paths that lead elsewhere. Each must end with a message and the right
exit status within a second of processor time and 500 MB of memory, and must neither read nor write a file that the user did not name.

    hostile_check.py [PROGRAM] [WORD]      default: build/release/musclesim, all cases; WORD: those with the word in their name

Under sanitizers, SLOWER=10 allows ten times the time and the memory.
"""

import json
import os
import pathlib
import resource
import shutil
import struct
import sys
import tempfile
import time
import zlib

root = pathlib.Path(__file__).resolve().parents[2]
slower = float(os.environ.get("SLOWER", "1"))
limit_s, limit_mb = 1.0 * slower, 500 * slower
killed_after_s = 20 * slower
bad_input, diverged, bad_usage = 3, 4, 2
secret = "root:x:0:0:secret-line"  # in a file that nobody named; no message may show it

cases = []


def case(name, *arguments, status=bad_input, words=(), forbidden=()):
    """A case: a function that writes files into the current folder. `arguments` of the program; exit status (or several), words of the
    message, files that must not exist afterwards."""

    def add(write):
        cases.append((name, write, list(arguments), (status,) if isinstance(status, int) else status, words, forbidden))
        return write

    return add


def put(name, text):
    path = pathlib.Path(name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode())


simple = ["--simple", "--quiet", "--duration", "0.1", "--out", "out"]
deep = 100_000

# Robot files.

robot_head = 'format = "musclesim-robot-1"\nname = "hostile"\n'
robot_body = '[[body]]\nname = "b"\nmass_g = %s\nat_mm = [0, 0, 0]\nshape = { type = "sphere", radius_mm = 10 }\n'
robot_joint = '[[joint]]\nname = "j"\ntype = "hinge"\nbody = "b"\nat_mm = [0, 0, 0]\naxis = "x"\n'


def robot(mass='"1"', more=""):
    put("hostile.toml", robot_head + robot_body % mass + robot_joint + more)


def bodies(count):
    form = '[[body]]\nname="b%d"\nmass_g=1\nat_mm=[%d,0,0]\nshape={type="sphere",radius_mm=1}\n'
    return "".join(form % (i, 3 * i) for i in range(count))


check = ["robot", "check", "hostile.toml"]


@case("robot: nested parentheses", *check, words=["hostile.toml"])
def _():
    robot('"' + "(" * deep + "1" + ")" * deep + '"')


@case("robot: parentheses nested as deep as there is room", *check, status=0)
def _():
    robot('"' + "(" * 499 + "1" + ")" * 499 + '"')


@case("robot: a force without end", *check, words=["hostile.toml", "characters"])
def _():
    form = '[[actuator]]\nname="a"\ntype="linear"\nfrom={body="b",at_mm=[0,0,0]}\nto={body="world",at_mm=[0,100,0]}\n'
    robot("1", form + 'length_mm=[50,150]\nforce_N="%s1"\n' % ("-" * deep))


@case("robot: nested functions", *check, words=["hostile.toml"])
def _():
    robot('"' + "sin(" * deep + "1" + ")" * deep + '"')


@case("robot: a chain of signs", *check, words=["hostile.toml"])
def _():
    robot('"' + "-" * deep + '1"')


@case("robot: nested conditions", *check, words=["hostile.toml"])
def _():
    robot('"' + "1?1:" * deep + '1"')


@case("robot: a tower of powers", *check, words=["hostile.toml"])
def _():
    robot('"' + "9^" * deep + '9"')


@case("robot: a long sum", *check, words=["hostile.toml"])
def _():
    robot('"' + "1+" * (4 * deep) + '1"')


@case("robot: many long expressions", *check, words=["hostile.toml"])
def _():
    form = '[[body]]\nname = "b%d"\nmass_g = "%s1"\nat_mm = [0,0,0]\nshape = {type="sphere",radius_mm=1}\n'
    robot('"1"', "".join(form % (i, "1+" * 450) for i in range(900)))


@case("robot: nested arrays", *check, words=["hostile.toml"])
def _():
    robot("[" * deep)


@case("robot: nested tables in a line", *check, words=["hostile.toml"])
def _():
    robot("{a=" * deep)


@case("robot: dotted keys", *check, words=["hostile.toml"])
def _():
    robot("1", ".".join(["a"] * deep) + " = 1\n")


@case("robot: dotted tables", *check, words=["hostile.toml"])
def _():
    robot("1", "[" + ".".join(["a"] * deep) + "]\n")


@case("robot: many bodies", *check, words=["hostile.toml"])
def _():
    put("hostile.toml", robot_head + bodies(13_000))


@case("robot: a million bodies", *check, words=["hostile.toml", "larger than"])
def _():
    put("hostile.toml", robot_head + bodies(1_000_000))


@case("robot: many bodies are simulated", *simple, "--robot", "hostile.toml", words=["hostile.toml"])
def _():
    put("hostile.toml", robot_head + bodies(13_000))


@case("robot: many parameters", *check, words=["hostile.toml"])
def _():
    robot("1", "".join("[parameter.p%d]\ndefault=1\nrange=[0,2]\n" % i for i in range(24000)))


@case("robot: an endless muscle", *check, words=["hostile.toml"])
def _():
    robot("1", '[[muscle]]\nname="m"\nfrom={body="b",at_mm=[0,0,0]}\nto={body="world",at_mm=[0,1e15,0]}\n'
          "minimum_length_mm=1e14\nmaximum_length_mm=1e16\n")


@case("robot: a line of a megabyte", *check, words=["hostile.toml"])
def _():
    put("hostile.toml", "x" * (1 << 20))


@case("robot: binary zeros", *check, words=["hostile.toml"])
def _():
    put("hostile.toml", b"\0" * 1000)


@case("robot: a link to another's file", *check, words=["hostile.toml"])
def _():
    os.symlink("../secret", "hostile.toml")


@case("robot: a device without end", *check, status=(3, 5), words=["hostile.toml"])
def _():
    os.symlink("/dev/zero", "hostile.toml")


@case("robot: a folder", *check, status=(3, 5), words=["hostile.toml"])
def _():
    os.mkdir("hostile.toml")


# Robots of other programs.

urdf_link = '<link name="%s"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'


def importing(suffix):
    return ["robot", "import", "hostile." + suffix, "-o", "out.toml"]


@case("urdf: nested elements", *importing("urdf"), words=["hostile.urdf"])
def _():
    put("hostile.urdf", '<robot name="r">' + "<a>" * deep + "</a>" * deep + "</robot>")


@case("urdf: entities that double (billion laughs)", *importing("urdf"), status=(0, 3))
def _():
    entities = "".join('<!ENTITY a%d "%s">' % (i, "&a%d;" % (i - 1) * 10) for i in range(1, 20))
    robot_text = '<robot name="&a19;"><link name="&a19;"/></robot>'
    put("hostile.urdf", '<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY a0 "ha">%s]>%s' % (entities, robot_text))


@case("urdf: an entity with another's file", *importing("urdf"), status=(0, 3))
def _():
    put("hostile.urdf", '<!DOCTYPE robot [<!ENTITY x SYSTEM "../secret">]><robot name="&x;"><link name="&x;"/></robot>')


@case("urdf: a million bodies", *importing("urdf"), words=["hostile.urdf"])
def _():
    put("hostile.urdf", '<robot name="r">' + "".join('<link name="b%d"/>' % i for i in range(1_000_000)) + "</robot>")


@case("urdf: thousands of bodies", *importing("urdf"), words=["hostile.urdf"])
def _():
    joint = ('<joint name="j%d" type="revolute"><parent link="b%d"/><child link="b%d"/><axis xyz="1 0 0"/>'
             '<limit effort="1" velocity="1" lower="-1" upper="1"/></joint>')
    links = "".join(urdf_link % ("b%d" % i) for i in range(8000))
    put("hostile.urdf", '<robot name="r">' + links + "".join(joint % (i, i, i + 1) for i in range(7999)) + "</robot>")


@case("urdf: a loop of joints", *importing("urdf"), words=["hostile.urdf"])
def _():
    joint = '<joint name="%s" type="fixed"><parent link="%s"/><child link="%s"/></joint>'
    links = "".join(urdf_link % n for n in "ab")
    put("hostile.urdf", '<robot name="r">' + links + joint % ("p", "a", "b") + joint % ("q", "b", "a") + "</robot>")


@case("urdf: a mesh of another's folder", *importing("urdf"), status=(0, 3))
def _():
    mesh = '<link name="b"><visual><geometry><mesh filename="file:///etc/passwd"/></geometry></visual></link>'
    joint = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/></joint>'
    put("hostile.urdf", '<robot name="r">' + urdf_link % "a" + mesh + joint + "</robot>")


@case("mjcf: nested bodies", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", "<mujoco><worldbody>" + "<body>" * deep + "</body>" * deep + "</worldbody></mujoco>")


@case("mjcf: nested defaults", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", "<mujoco>" + "".join('<default class="c%d">' % i for i in range(450)) + "</default>" * 450 + "<worldbody/></mujoco>")


@case("mjcf: includes itself", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", '<mujoco><include file="hostile.xml"/></mujoco>')


@case("mjcf: includes itself by another name", *importing("xml"), words=["included twice"])
def _():
    put("hostile.xml", '<mujoco><include file="link.xml"/></mujoco>')
    for i in range(200):
        os.symlink("hostile.xml", "link.xml" if i == 0 else "link%d.xml" % i)


@case("mjcf: a chain of includes", *importing("xml"), words=["more than 200 files"])
def _():
    put("hostile.xml", '<mujoco><include file="f1.xml"/></mujoco>')
    for i in range(1, 3000):
        put("f%d.xml" % i, '<mujoco><include file="f%d.xml"/></mujoco>' % (i + 1))


@case("mjcf: includes another's file", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", '<mujoco><include file="../secret"/></mujoco>')


@case("mjcf: includes another's file by its whole path", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", '<mujoco><include file="%s"/></mujoco>' % pathlib.Path("../secret").resolve())


@case("mjcf: includes another's file by a link", *importing("xml"), words=["hostile.xml"])
def _():
    os.symlink("../secret", "link.xml")
    put("hostile.xml", '<mujoco><include file="link.xml"/></mujoco>')


@case("mjcf: includes a device without end", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", '<mujoco><include file="/dev/zero"/></mujoco>')


@case("mjcf: a million bodies", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", "<mujoco><worldbody>" + '<body><geom size="1"/></body>' * 1_000_000 + "</worldbody></mujoco>")


@case("mjcf: thousands of bodies", *importing("xml"), words=["hostile.xml"])
def _():
    put("hostile.xml", "<mujoco><worldbody>" + '<body><joint/><geom size="1"/></body>' * 20_000 + "</worldbody></mujoco>")


sdf_model = '<sdf version="1.9"><model name="m">%s</model></sdf>'


@case("sdf: nested models", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % ("".join('<model name="n"><link name="l"/>' for i in range(deep)) + "</model>" * deep))


@case("sdf: models nested a hundred times", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % ("".join('<model name="n%d"><link name="l"/>' % i for i in range(100)) + "</model>" * 100))


@case("sdf: includes itself", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % '<link name="l"/><include><uri>hostile.sdf</uri></include>')


@case("sdf: includes itself in a circle", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % '<link name="l"/><include><uri>model://other</uri></include>')
    put("other/model.config", '<model><name>o</name><sdf version="1.9">model.sdf</sdf></model>')
    put("other/model.sdf", sdf_model % '<link name="l"/><include><uri>hostile.sdf</uri></include>')


@case("sdf: includes another's file", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % '<link name="l"/><include><uri>../secret</uri></include>')


@case("sdf: includes another's file, whole path", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % ('<link name="l"/><include><uri>file://%s</uri></include>' % pathlib.Path("../secret").resolve()))


@case("sdf: thousands of shapes", *importing("sdf"), words=["hostile.sdf"])
def _():
    shapes = "".join('<visual name="v%d"><geometry><box/></geometry></visual>' % i for i in range(50_000))
    put("hostile.sdf", sdf_model % ('<link name="l"/><link name="k">' + shapes + "</link>"))


@case("sdf: thousands of bodies", *importing("sdf"), words=["hostile.sdf"])
def _():
    put("hostile.sdf", sdf_model % "".join('<link name="l%d"/>' % i for i in range(20000)))


# Recordings and their sidecars.

table = "time_s,command_0,command_1,angle_elbow_deg\n" + "".join("%g,0.5,0.3,1\n" % (0.01 * i) for i in range(11))


def recording(**members):
    put("rec.csv", table)
    put("rec.json", json.dumps({"format": "musclesim-recording-1", "robot": "elbow", **members}))


replay = ["replay", "rec.csv", "--quiet"]


@case("sidecar: nested lists", *replay, words=["rec.json"])
def _():
    put("rec.csv", table)
    put("rec.json", '{"format":"musclesim-recording-1","robot":"elbow","x":' + "[" * deep)


@case("sidecar: nested objects", *replay, words=["rec.json"])
def _():
    put("rec.csv", table)
    put("rec.json", '{"format":"musclesim-recording-1","robot":"elbow","robot_parameters":' + '{"a":' * deep + "1" + "}" * deep + "}")


@case("sidecar: a million parameters", *replay, status=(2, 3), words=["rec.json"])
def _():
    recording(robot_parameters={"p%d" % i: 1 for i in range(1_000_000)})


@case("sidecar: many parameters", *replay, status=(2, 3), words=["rec.json"])
def _():
    recording(robot_parameters={"p%d" % i: 1 for i in range(20_000)})


@case("sidecar: many unknown members", *replay, status=(0, 2, 3))
def _():
    recording(**{"member%d" % i: 1 for i in range(100_000)})


@case("sidecar: many effects", *replay, status=(2, 3), words=["rec.json"])
def _():
    recording(active_effects=[{"id": "valve_lag", "component": "all", "parameters": {}}] * 100_000)


@case("sidecar: its robot is another's file", *replay, words=["rec.json"])
def _():
    recording(robot="../secret")


@case("sidecar: its robot is another's file with the right ending", *replay, words=["secret.toml"])
def _():
    recording(robot="../secret.toml")


@case("sidecar: its robot is another's file, whole path", *replay, words=["secret.toml"])
def _():
    recording(robot=str(pathlib.Path("../secret.toml").resolve()))


@case("sidecar: its robot is a link to another's file", *replay, words=["link.toml"])
def _():
    os.symlink("../secret.toml", "link.toml")
    recording(robot="link.toml")


@case("sidecar: its run names files elsewhere", "rerun", "rec.csv", words=["rec.json"])
def _():
    recording(run={"arguments": ["--config", "/etc/passwd"], "build": {}, "files": [
        {"option": "--config", "given": "/etc/passwd", "hash": "0", "copy": "../secret.toml"}]})


escaped = ["../escaped.csv", "../escaped.png", "../escaped.log"]


@case("sidecar: its run writes files elsewhere", "rerun", "rec.csv", status=(0, 3), forbidden=escaped)
def _():
    arguments = ["--robot", "elbow", "--record", escaped[0], "--screenshot", escaped[1], "--window-log", escaped[2]]
    recording(run={"arguments": arguments, "build": {}, "files": []})


@case("sidecar: its run is without end", "rerun", "rec.csv", status=(0, 3))
def _():
    recording(run={"arguments": ["--robot", "elbow", "--duration", "1e7", "--step", "1e-2"], "build": {}, "files": []})


@case("sidecar: a step without end", *replay, status=(2, 3), words=["step"])
def _():
    recording(step_s=1e-300)


@case("sidecar: many internal steps", *replay, status=(2, 3), words=["substeps"])
def _():
    recording(substeps=2_000_000_000)


@case("recording: a line without end", *replay, words=["rec.csv"])
def _():
    recording()
    put("rec.csv", "time_s,command_0" + "1" * (2 << 20))


@case("recording: too many columns", *replay, words=["rec.csv"])
def _():
    recording()
    put("rec.csv", "time_s," + ",".join("command_%d" % i for i in range(50_000)))


@case("recording: many names given twice", *replay, words=["rec.csv"])
def _():
    recording()
    put("rec.csv", ",".join(["time_s"] * 900))


@case("recording: too large", *replay, words=["rec.csv", "larger than"])
def _():
    recording()
    os.truncate("rec.csv", 1 << 40)  # a hole: no disk is needed


@case("recording: a device without end", *replay, status=(3, 5), words=["rec.csv"])
def _():
    recording()
    os.remove("rec.csv")
    os.symlink("/dev/zero", "rec.csv")


@case("recording: a time without end", *replay, status=(0, 3))
def _():
    recording()
    put("rec.csv", "time_s,command_0,command_1\n0,0,0\n1e300,1,1\n")


# Commands, next.csv, targets.


@case("schedule: a line without end", *simple, "--robot", "elbow", "--commands", "next.csv", words=["next.csv"])
def _():
    put("next.csv", "time_s,command_0\n0," + "1" * (2 << 20))


@case("schedule: binary zeros", *simple, "--robot", "elbow", "--commands", "next.csv", words=["next.csv"])
def _():
    put("next.csv", b"\0" * 100_000)


@case("schedule: no numbers", *simple, "--robot", "elbow", "--commands", "next.csv", words=["next.csv"])
def _():
    put("next.csv", "time_s,command_0,command_1\n0,nan,inf\n")


@case("schedule: a million muscles", *simple, "--robot", "elbow", "--commands", "next.csv", words=["next.csv"])
def _():
    put("next.csv", "time_s," + ",".join("command_%d" % i for i in range(1_000_000)))


@case("schedule: its sidecar's robot is elsewhere", *simple, "--robot", "elbow", "--commands", "next.csv", status=(0, 3))
def _():
    put("next.csv", table)
    put("next.json", json.dumps({"format": "musclesim-recording-1", "robot": "../secret.toml"}))


# Effects and configuration.

effects = [*simple, "--robot", "elbow", "--effects", "effects.json"]


def effects_file(list_):
    put("effects.json", json.dumps({"format": "musclesim-effects-1", "effects": list_}))


@case("effects: nested lists", *effects, words=["effects.json"])
def _():
    put("effects.json", '{"format": "musclesim-effects-1", "effects": ' + "[" * deep)


@case("effects: many effects", *effects, status=(2, 3))
def _():
    effects_file([{"id": "valve_lag", "component": "all", "parameters": {}}] * 10_000)


@case("effects: a lag without end", *effects, status=(2, 3))
def _():
    effects_file([{"id": "transport_delay", "component": "all", "parameters": {"delay_s": 1e18}}])


@case("effects: quantisation without end", *effects, status=0)
def _():
    effects_file([{"id": "command_quantisation", "component": "all", "parameters": {"bits": 1e18}}])


@case("effects: a long name", *effects, status=(2, 3))
def _():
    effects_file([{"id": "v" * 500_000, "component": "all", "parameters": {}}])


@case("configuration: dotted keys", *simple, "--config", "c.toml", words=["c.toml"])
def _():
    put("c.toml", ".".join(["a"] * deep) + " = 1\n")


@case("configuration: a link to another's file", *simple, "--config", "c.toml", words=["c.toml"])
def _():
    os.symlink("../secret", "c.toml")


# Tables of other programs and their mappings.

mapping = 'robot = "elbow"\n%s\n[columns]\ntime_s = "t"\ncommand_0 = "a"\ncommand_1 = "b"\n%s'


def foreign(before="", after=""):
    put("log.csv", "t,a,b\n0,0,0\n1,1,1\n")
    put("map.toml", mapping % (before, after))


importing_table = ["import", "log.csv", "map.toml", "out.csv"]


@case("mapping: dotted keys", *importing_table, words=["map.toml"])
def _():
    foreign(".".join(["a"] * deep) + " = 1\n")


@case("mapping: nested arrays", *importing_table, words=["map.toml"])
def _():
    foreign("trial = " + "[" * deep)


@case("mapping: takes columns from another's file", *importing_table, words=["map.toml"])
def _():
    foreign(after='angle_elbow_deg = { from = "x", table = "../secret" }\n')


@case("mapping: takes columns from another's file, whole path", *importing_table, words=["map.toml"])
def _():
    foreign(after='angle_elbow_deg = { from = "x", table = "/etc/passwd" }\n')


@case("mapping: takes columns from another's file by a link", *importing_table, words=["map.toml"])
def _():
    os.symlink("../secret", "link.csv")
    foreign(after='angle_elbow_deg = { from = "x", table = "link.csv" }\n')


@case("mapping: its robot is elsewhere", *importing_table, status=(0, 3))
def _():
    put("log.csv", "t,a,b\n0,0,0\n1,1,1\n")
    put("map.toml", (mapping % ("", "")).replace('"elbow"', '"../secret.toml"'))


@case("mapping: an average without end", *importing_table, status=(0, 3))
def _():
    foreign(after="[rows]\nevery = 1000000000000\n")


@case("table: a million columns", *importing_table, words=["log.csv"])
def _():
    foreign()
    put("log.csv", "t,a,b" + ",x" * 400_000 + "\n")


@case("table: open quotes", *importing_table, words=["log.csv"])
def _():
    foreign()
    put("log.csv", 't,a,b\n"' + "0,0,0\n" * 200_000)


@case("table: looked at, a line without end", "import", "--look", "log.csv", words=["log.csv"])
def _():
    put("log.csv", ";" * (5 << 20))


@case("table: looked at, open quotes", "import", "--look", "log.csv", status=(0, 3))
def _():
    put("log.csv", '"' * 500_000 + "\n" + '"a"' * 100_000)


@case("table: looked at, zeros of UTF-16", "import", "--look", "log.csv", status=(0, 3))
def _():
    put("log.csv", b"\xff\xfe" + b"\0\xd8" * 500_000)


@case("table: a hole as large as a disk", *importing_table, words=["log.csv", "larger than"])
def _():
    foreign()
    os.truncate("log.csv", 1 << 40)


@case("points: no table", "fit", "points.csv", "--out", "out", words=["points.csv"])
def _():
    put("points.csv", "pressure,length_mm,force_N\n" + "x" * (2 << 20))


# MATLAB files of version 5, written by hand: elements of type, size and bytes.

matlab_head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)


def element(type_, bytes_):
    return struct.pack("<II", type_, len(bytes_)) + bytes_ + b"\0" * (-len(bytes_) % 8)


def array_head(name, sides, class_=6):
    return element(6, struct.pack("<II", class_, 0)) + element(5, struct.pack("<%di" % len(sides), *sides)) + element(1, name.encode())


def matrix(name, sides, data, class_=6):
    return element(14, array_head(name, sides, class_) + data)


def compressed_zeros(name, count):
    """A matrix of `count` doubles, all 0, as a compressed element of a few kilobytes."""
    body_bytes = len(array_head(name, [count, 1])) + 8 + 8 * count
    press = zlib.compressobj(9)
    stream = press.compress(struct.pack("<II", 14, body_bytes) + array_head(name, [count, 1]) + struct.pack("<II", 9, 8 * count))
    zeros = bytes(8 << 20)
    for _ in range(count >> 20):
        stream += press.compress(zeros)
    return struct.pack("<II", 15, len(stream)) + stream + b""


def matlab(content):
    put("log.mat", matlab_head + content)
    put("map.toml", mapping % ("", ""))


importing_matlab = ["import", "log.mat", "map.toml", "out.csv"]


@case("matlab: a decompression bomb", *importing_matlab, words=["log.mat"])
def _():
    matlab(compressed_zeros("t", 256 << 20))


@case("matlab: many bombs in a file", *importing_matlab, words=["log.mat"])
def _():
    matlab(b"".join(compressed_zeros(name, 6 << 20) for name in ["t", "a", "b"] + ["x%d" % i for i in range(60)]))


@case("matlab: a bomb that is only looked at", "import", "--look", "log.mat", words=["log.mat"])
def _():
    matlab(compressed_zeros("t", 256 << 20))


@case("matlab: sides that the file does not have", *importing_matlab, words=["log.mat"])
def _():
    matlab(matrix("t", [2_000_000_000, 1], element(9, bytes(80))))


@case("matlab: sides whose product overflows", *importing_matlab, words=["log.mat"])
def _():
    matlab(matrix("t", [1 << 30, 1 << 30, 16], element(9, bytes(80))))


@case("matlab: negative sides", *importing_matlab, words=["log.mat"])
def _():
    matlab(matrix("t", [-5, 1], element(9, bytes(80))))


@case("matlab: a hundred thousand dimensions", *importing_matlab, words=["log.mat"])
def _():
    matlab(matrix("t", [1] * deep, element(9, bytes(8))))


@case("matlab: nested cells", *importing_matlab, words=["log.mat"])
def _():
    inner, depth = b"", 20_000
    head = element(6, struct.pack("<II", 1, 0)) + element(5, struct.pack("<2i", 1, 1)) + element(1, b"")
    sizes, total = [], 0
    for _ in range(depth):
        total += len(head) + 8
        sizes.append(total - 8)
    content = b"".join(struct.pack("<II", 14, size) + head for size in reversed(sizes))
    matlab(content + inner)


@case("matlab: nested cells, compressed", *importing_matlab, words=["log.mat"])
def _():
    head = element(6, struct.pack("<II", 1, 0)) + element(5, struct.pack("<2i", 1, 1)) + element(1, b"")
    depth = 200_000
    content = b"".join(struct.pack("<II", 14, (len(head) + 8) * (depth - i) - 8) + head for i in range(depth))
    stream = zlib.compress(content)
    matlab(struct.pack("<II", 15, len(stream)) + stream)


@case("matlab: a structure of a billion elements", *importing_matlab, words=["log.mat"])
def _():
    fields = struct.pack("<HHI", 5, 4, 32) + element(1, b"f".ljust(32, b"\0"))
    matlab(matrix("t", [1_000_000_000, 1], fields, class_=2))


@case("matlab: the head alone", *importing_matlab, words=["log.mat"])
def _():
    matlab(b"")


@case("matlab: HDF5 in name only", *importing_matlab, words=["log.mat"])
def _():
    put("log.mat", b"MATLAB 7.3 MAT-file".ljust(124) + struct.pack("<HH", 0x0200, 0x4D49) + bytes(384) + b"\x89HDF\r\n\x1a\n" + bytes(1000))
    put("map.toml", mapping % ("", ""))


# Plugins: code is trusted, but what is none must not crash the program.

plugin = [*simple, "--plugin", "./hostile.so"]


def library():
    """Some shared library that is no plugin."""
    found = [*pathlib.Path("/usr/lib").glob("*/libz.so.1"), *pathlib.Path("/usr/lib").glob("*/libm.so.6")]
    return found[0].read_bytes() if found else b"\x7fELF"


@case("plugin: a text", *plugin, words=["hostile.so"])
def _():
    put("hostile.so", "no library")


@case("plugin: an empty file", *plugin, words=["hostile.so"])
def _():
    put("hostile.so", "")


@case("plugin: a cut library", *plugin, words=["hostile.so"])
def _():
    put("hostile.so", library()[:5000])


@case("plugin: a library without the function", *plugin, words=["hostile.so"])
def _():
    put("hostile.so", library())


@case("plugin: a folder", *plugin, words=["hostile.so"])
def _():
    os.mkdir("hostile.so")


def run(program, arguments):
    """Exit status (negative: signal), messages, processor time in s, memory in MB."""
    with open("stdout.txt", "wb") as out, open("stderr.txt", "wb") as err:
        child = os.fork()
        if child == 0:
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_CPU, (int(killed_after_s), int(killed_after_s)))
            if slower == 1:
                resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
            for name in ("DISPLAY", "WAYLAND_DISPLAY"):
                os.environ.pop(name, None)
            os.execv(program, [str(program)] + arguments)
        _, status, used = os.wait4(child, 0)
    text = "".join(pathlib.Path(name).read_bytes().decode(errors="replace") for name in ("stderr.txt", "stdout.txt"))
    code = -os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
    return code, text, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main():
    program = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/musclesim").resolve()
    word = sys.argv[2] if len(sys.argv) > 2 else ""
    failures = slowest_s = largest_mb = count = 0
    base = pathlib.Path(tempfile.mkdtemp(prefix="musclesim_hostile_"))
    try:
        for name, write, arguments, statuses, words, forbidden in cases:
            if word not in name:
                continue
            count += 1
            folder = base / "case"
            folder.mkdir()
            (base / "secret").write_text(secret + "\n")
            (base / "secret.toml").write_text(secret + "\n")
            os.chdir(folder)
            write()
            status, text, time_s, memory_mb = run(program, arguments)
            slowest_s, largest_mb = max(slowest_s, time_s), max(largest_mb, memory_mb)
            problems = []
            if status not in statuses:
                problems.append("ended with %d" % status)
            if time_s > limit_s:
                problems.append("took %.1f s" % time_s)
            if memory_mb > limit_mb:
                problems.append("took %.0f MB" % memory_mb)
            if status not in (0,) and not text.strip():
                problems.append("says nothing")
            if status and len(text) > 4000:
                problems.append("a message of %d characters" % len(text))
            problems += ["does not say \"%s\"" % w for w in words if w not in text]
            if "secret-line" in text:
                problems.append("shows another's file")
            problems += ["wrote " + f for f in forbidden if os.path.exists(f)]
            if problems:
                failures += 1
                print("%s: %s\n    %s" % (name, ", ".join(problems), text.strip()[:300].replace("\n", "\n    ")), flush=True)
            os.chdir(base)
            shutil.rmtree(folder)
            for extra in base.glob("escaped*"):
                extra.unlink()
    finally:
        os.chdir("/")
        shutil.rmtree(base)
    print("%d hostile inputs, %d not as they should be" % (count, failures))
    print("the slowest took %.2f s of processor time, the largest %.0f MB" % (slowest_s, largest_mb))
    sys.exit(1 if failures or not count else 0)


main()
