"""A controller in Python on the elbow, a plot, and the diagnosis of recordings: python3 elbow.py"""
import matplotlib.pyplot as plt
import numpy as np
import musclesim

LINE = {"muscle.model": "line"}  # massless muscles: fast
NOISE = {"sensor.angle_noise_deg": 0.1, "sensor.pressure_noise_ratio": 0.002}
LAG = [{"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.08, "vent_time_constant_s": 0.15}}]


def swing(state):
    return 0.5 + 0.3 * np.sin(np.pi * state.time_s + np.array([0, np.pi]))  # pressures of flexor and extensor


def machine(controller):  # a recording that stands for one of a real machine: it does not know its lag
    run = musclesim.run("elbow", controller, 8, parameters={**LINE, **NOISE}, effects=LAG, decision_interval_s=0.4)
    measured = {name: run[name] for name in run.keys() if name.startswith(("time", "command", "pressure", "angle"))}
    return musclesim.Recording.from_dict(measured, robot="elbow", robot_parameters=LINE)


slow, steps = machine(swing), machine("random")
plt.plot(slow["time_s"], slow["angle_elbow_deg"], slow["time_s"], musclesim.replay(slow).simulated["angle_elbow_deg"])
plt.gca().set(xlabel="time in s", ylabel="angle in degrees: machine, model"), plt.savefig("elbow.svg")
print("causes:", musclesim.diagnose([slow, steps]).causes)
