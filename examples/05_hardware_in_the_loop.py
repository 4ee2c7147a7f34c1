# %% [markdown]
# # Hardware in the loop
#
# A controller on a computer of its own gets packets with what the sensors show and answers with voltages; the environment is the
# blade. At every interval $\Delta t$
#
# $$
# y_k \;\xrightarrow{\text{UDP}}\; \xi_{k+1} = F\xi_k + G y_k + H u_k,\quad u_k = \mathrm{clip}(M\xi_k + T y_k)
# \;\xrightarrow{\text{UDP}}\; u_k
# $$
#
# must be there and back. Here the other computer is a process on this one: the C file that `beamenv export lqg` writes, compiled
# with `examples/hardware/udp.c`. On real hardware only the address changes, and the sockets become those of your converters.

# %%
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import gymnasium as gym
import numpy as np

import beamenv
from beamenv.baselines import reference_lqg
from beamenv.train.export import export

PATIENCE = 5.0  # s
env = gym.make(beamenv.ENV_ID, scenario="pulse", physical_units=True, dtype="float64")
design = env.unwrapped.design
law = reference_lqg(design.full_plant)


def episode(decide):
    """Cost, J s, of one episode under voltages that ``decide`` gives for readings, and all of these voltages."""
    observation, _ = env.reset(seed=0)
    cost, asked, over = 0.0, [], False
    while not over:
        asked.append(decide(observation))
        observation, _, terminated, truncated, info = env.step(asked[-1])
        cost, over = cost + info["cost_increment"], terminated or truncated
    return cost, np.array(asked)


# %% [markdown]
# The controller in the loop directly, in Python:

# %%
direct, memory = law.in_physical_units(), None


def by_python(readings):
    """Voltages (m,), V."""
    global memory
    volts, memory = direct.predict(readings, memory)
    return volts


cost, voltages = episode(by_python)
print(f"in Python:           J = {1e6 * cost:.4f} µJ s")

# %% [markdown]
# The other computer. Without a C compiler, or on Windows, a Python process takes its place.

# %%
HARDWARE = Path(__file__).parent / "hardware"
folder = Path(tempfile.mkdtemp())
compiler = shutil.which("cc") if sys.platform != "win32" else None
if compiler:
    export(law, design.plant, folder / "lqg.c", name="lqg")
    program = [str(folder / "udp")]
    subprocess.run([compiler, "-std=c99", "-O2", f"-I{folder}", str(HARDWARE / "udp.c"), "-o", *program, "-lm"], check=True)
else:
    program = [sys.executable, str(HARDWARE / "udp.py")]
other = subprocess.Popen(program, stdout=subprocess.PIPE, text=True)
address = ("127.0.0.1", int(other.stdout.readline() or sys.exit(f"{program[0]} has ended before it began")))

# %% [markdown]
# Each packet has a number, by which an answer that is late is known from the one that is waited for.

# %%
link, round_trips = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), []
link.settimeout(PATIENCE)


def answered(number):
    """The answer to a packet; those to earlier ones are left aside."""
    answer = np.frombuffer(link.recv(1024))
    return answer[1:] if answer[0] == number else answered(number)


def by_hardware(readings):
    """Voltages (m,), V, from the other computer."""
    number, start = float(len(round_trips)), time.perf_counter()
    link.sendto(np.concatenate([[number], readings]).tobytes(), address)
    try:
        volts = answered(number)
    except TimeoutError:
        raise SystemExit(f"the controller at {address} did not answer packet {number:.0f} within {PATIENCE:g} s") from None
    round_trips.append(time.perf_counter() - start)
    return volts


try:
    cost_there, voltages_there = episode(by_hardware)
finally:
    link.sendto(b"", address)  # it ends
    link.close()
    other.wait(PATIENCE + 1.0)
    other.stdout.close()
    shutil.rmtree(folder)
    env.close()

# %%
median, slowest = 1e6 * np.median(round_trips), 1e6 * np.max(round_trips)
interval = 1e6 * design.plant.control_interval
apart = np.abs(voltages_there - voltages).max()
print(f"in another process:  J = {1e6 * cost_there:.4f} µJ s, voltages within {apart:.1e} V of those in Python")
print(f"there and back: {median:.0f} µs in the median, {slowest:.0f} µs at most; the interval is {interval:.0f} µs")
assert abs(cost_there / cost - 1.0) < 1e-9
