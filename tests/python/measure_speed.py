"""Control steps per second of the elbow with line muscles through Python, on one core, and how much slower than within the library.

Ratios are taken within one run of this script, in turns, from the fastest of five: other work on the machine disturbs them little.
    PYTHONPATH=build/release/python python3 tests/python/measure_speed.py
"""
import time

import numpy as np

import musclesim

line = {"muscle.model": "line"}
count = 20000
command = np.array([0.6, 0.2])
simulation = musclesim.Simulation("elbow", parameters=line)


class Constant(musclesim.Controller):
    def output(self, state):
        return command


def single_steps():
    for _ in range(count):
        simulation.step(command)


def run(controller, law=None):
    def work():
        musclesim.run("elbow", controller, count * 0.01, parameters={**line, "hold.pressure_0": 0.6, "hold.pressure_1": 0.2}
                      if controller == "hold" else line, record_interval_s=1, force_law=law)
    return work


class Law(musclesim.ForceLaw):
    def __init__(self, muscle, minimum_length_mm, maximum_length_mm):
        super().__init__()
        self.law = musclesim.BraunForceLaw(minimum_length_mm, maximum_length_mm)

    def tension_N(self, pressure, length_mm):
        return self.law.tension_N(pressure, length_mm)


ways = {"step(command, count): one call": lambda: simulation.step(command, count), "step(command): a call per step": single_steps,
        "run under hold": run("hold"), "run under a controller in Python": run(Constant()),
        "run under a controller and a force law in Python": run(Constant(), Law)}
fastest_s = dict.fromkeys(ways, float("inf"))
simulation.start(command)
for _ in range(5):
    for name, work in ways.items():
        begin = time.process_time()
        work()
        fastest_s[name] = min(fastest_s[name], time.process_time() - begin)
reference_s = next(iter(fastest_s.values()))
for name, elapsed_s in fastest_s.items():
    print(f"{name:50s} {count / elapsed_s:8.0f} steps/s {elapsed_s / reference_s:5.2f} x the time of one call")
