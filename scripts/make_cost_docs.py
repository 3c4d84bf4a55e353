#!/usr/bin/env python3
"""Measures what diagnoses and sweeps cost, and writes docs/reference/diagnosis_cost.md.

    scripts/make_cost_docs.py [--build BUILD_FOLDER] [--only SECTION,...] [--keep FOLDER]

The machines are simulated: the program records shipped robots with known effects and noise, and diagnoses the recordings on one core. Processor time is that
of the process, so that other work on the machine changes it little. Half an hour; --only measures some sections for a look and writes no page.
"""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
PAGE = f'{ROOT}/docs/reference/diagnosis_cost.md'
NOISE = ['sensor.length_noise_mm=0.05', 'sensor.pressure_noise_ratio=0.003', 'sensor.force_noise_N=0.3']
NOISE_OF_JOINTS = ['sensor.angle_noise_deg=0.05', 'sensor.hand_noise_mm=0.1']  # the rig has none
RECORDED_S = 4  # length of a recording, unless a table says otherwise
EFFECTS = [('valve_lag', 'all', {'fill_time_constant_s': 0.05, 'vent_time_constant_s': 0.08}),
           ('joint_coulomb_friction', 'joint_elbow', {'torque_Nm': 0.3}),
           ('pressure_calibration', 'muscle_0', {'gain': 1.08}),
           ('sensor_bias', 'signal_angle_elbow', {'offset': 1.5})]
LAG = EFFECTS[:1]


class Measured:
    """What one process took."""

    def __init__(self, command):
        start = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.wall_s = time.monotonic() - start
        self.cpu_s = usage.ru_utime + usage.ru_stime
        self.memory_MB = usage.ru_maxrss / 1024
        if process.returncode:
            sys.exit(f"make_cost_docs.py: {' '.join(command)}\nended with status {process.returncode}: {errors}")


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.run_count = 0

    def place(self, kind):
        self.run_count += 1
        return f'{self.folder}/{kind}{self.run_count}'

    def record(self, robot, muscle, effects, seed, duration_s):
        """A recording of a robot with these effects under random commands; its path."""
        name = self.place('recording')
        noise = NOISE + (NOISE_OF_JOINTS if robot != 'rig' else [])
        with open(f'{name}.effects.json', 'w', encoding='utf-8') as file:
            json.dump({'format': 'musclesim-effects-1',
                       'effects': [{'id': i, 'component': c, 'parameters': p} for i, c, p in effects]}, file)
        Measured([self.program, '--simple', '--quiet', '--robot', robot, '--muscle', muscle, '--controller', 'random', '--decision-interval', '0.4',
                  '--duration', str(duration_s), '--seed', str(seed), '--effects', f'{name}.effects.json',
                  *[word for number in noise for word in ('--set', number)], '--record', f'{name}.csv', '--out', f'{name}.run'])
        return f'{name}.csv'

    def diagnose(self, robot, muscle, effects, count=3, duration_s=RECORDED_S):
        files = [self.record(robot, muscle, effects, seed, duration_s) for seed in range(1, count + 1)]
        out = self.place('answer')
        measured = Measured([self.program, 'diagnose', *files, '--without-active-effects', '--jobs', '1', '--quiet', '--out', out])
        with open(f'{out}/diagnosis.json', encoding='utf-8') as file:
            answer = json.load(file)
        measured.simulations = answer['cost']['simulations']
        measured.simulated_s = answer['cost']['simulated_s']
        measured.verdict = answer['verdict']
        print(f"{robot} {muscle} {len(effects)} effects, {count} recordings of {duration_s} s: {measured.cpu_s:.0f} s", file=sys.stderr)
        return measured


COST_HEAD = 'verdict | simulations | simulated s per CPU s | memory MB | CPU s'


def row(first, one):
    return (f'| {first} | `{one.verdict}` | {one.simulations} | {one.simulated_s / one.cpu_s:.0f} | {one.memory_MB:.0f} | {one.cpu_s:.0f} |')


def table(head, rows):
    return '\n'.join([f'| {head} | {COST_HEAD} |', '|---' * 6 + '|', *rows])


def over_robots(bench):
    kinds = [('rig', 'line', 1), ('elbow', 'line', 2), ('wrist', 'line', 2), ('pulley_arm', 'line', 6), ('rig', 'chain', 1), ('elbow', 'chain', 2)]
    measured = {f'{robot}, {muscles} {"muscle" if muscles == 1 else "muscles"} as {"chains" if muscle == "chain" else "lines"}':
                bench.diagnose(robot, muscle, LAG) for robot, muscle, muscles in kinds}
    return ('Three recordings of 4 s of a machine whose valves lag. A *chain* is a muscle of beads, links and sliders, a *line* a massless one.\n\n' +
            table('robot', [row(name, one) for name, one in measured.items()]) + '\n\n' + thousand(measured))


def thousand(measured):
    """Diagnoses are processes that share nothing, so that a cluster needs the sum of their processor times."""
    lines = ['A thousand such diagnoses are a thousand processes that share nothing ([sweeps](../user/sweeps.md) run them: `command = ["diagnose", ...]`). '
             'A cluster of 64 cores like this one needs:', '', '| robot | core hours | hours on 64 cores | memory of 64 processes, GB |', '|---|---|---|---|']
    for name, one in measured.items():
        hours = one.cpu_s * 1000 / 3600
        lines.append(f'| {name} | {hours:.1f} | {hours / 64:.2f} | {one.memory_MB * 64 / 1024:.1f} |')
    return '\n'.join(lines)


def over_effects(bench):
    rows = [row(str(count), bench.diagnose('elbow', 'line', EFFECTS[:count])) for count in range(len(EFFECTS) + 1)]
    return 'The elbow with lines and so many causes: a lag, dry friction in its joint, a wrong pressure scale, a biased angle.\n\n' + table('causes', rows)


def over_recordings(bench):
    rows = [row(f'{count} of {duration_s} s', bench.diagnose('elbow', 'line', EFFECTS[:2], count, duration_s))
            for count, duration_s in [(3, 2), (3, 4), (3, 12), (3, 36), (6, 4), (12, 4)]]
    return ('The elbow with lines and two causes. The search uses 12 s of up to three recordings, the last fits all of them.\n\n' +
            table('recordings', rows))


def over_workers(bench):
    lines = ['Forty runs of 20 s of the elbow with lines, by workers that share a folder (`musclesim work`), on a machine with '
             f'{os.cpu_count()} cores:', '', '| workers | wall s | CPU s | runs per s |', '|---|---|---|---|']
    for workers in (1, 2, 4):
        folder = bench.place('sweep')
        with open(f'{folder}.toml', 'w', encoding='utf-8') as file:
            file.write('format = "musclesim-sweep-1"\ncommand = ["run", "--simple", "--robot", "elbow", "--muscle", "line", "--controller", "random", '
                       '"--duration", "20", "--seed", "{seed}", "--out", "{out}", "--json", "--quiet"]\n[repeats]\ncount = 40\n')
        Measured([bench.program, 'plan', f'{folder}.toml', '-o', folder])
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        running = [subprocess.Popen([bench.program, 'work', folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(workers)]
        if any(process.wait() for process in running):
            sys.exit('make_cost_docs.py: a worker failed')
        wall_s, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        lines.append(f'| {workers} | {wall_s:.1f} | {cpu_s:.1f} | {40 / wall_s:.1f} |')
    return '\n'.join(lines)


SECTIONS = {'robots': ('Robots, and a thousand diagnoses', over_robots), 'causes': ('Number of causes', over_effects),
            'recordings': ('Number and length of recordings', over_recordings), 'workers': ('Sweeps', over_workers)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', default=f'{ROOT}/build/release', help='folder with the program (default: build/release)')
    parser.add_argument('--only', help=f"sections, of {', '.join(SECTIONS)}; printed, no page is written")
    parser.add_argument('--keep', help='folder for recordings and answers (default: a temporary one)')
    arguments = parser.parse_args()
    chosen = arguments.only.split(',') if arguments.only else list(SECTIONS)
    if unknown := [name for name in chosen if name not in SECTIONS]:
        parser.error(f"there is no section {unknown[0]}; {', '.join(SECTIONS)} are")
    program = os.path.realpath(f'{arguments.build}/musclesim')
    if not os.access(program, os.X_OK):
        parser.error(f'there is no program {program}; build it first')
    version = subprocess.run(['git', '-C', ROOT, 'rev-parse', '--short', 'HEAD'], capture_output=True, text=True, check=True).stdout.strip()
    folder = arguments.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    try:
        bench = Bench(program, folder)
        parts = [f'## {SECTIONS[name][0]}\n\n{SECTIONS[name][1](bench)}\n' for name in chosen]
    finally:
        if not arguments.keep:
            shutil.rmtree(folder)
    page = '\n'.join(['# What a diagnosis costs\n', f'<!-- Made by scripts/make_cost_docs.py, version {version}; do not edit. -->\n',
                      'A diagnosis costs what its simulations cost; their number grows with the causes that a machine has, because every cause that is found is '
                      'looked at with every other effect beside it and in its place. Processor time is that of one core; two threads take a little more '
                      'than half as long. Machines differ: compare rows, not seconds.\n', *parts])
    if arguments.only:
        print(page)
        return
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(page)
    print(PAGE, file=sys.stderr)


if __name__ == '__main__':
    main()
