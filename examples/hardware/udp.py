"""What ``udp.c`` does, in Python, for computers without a C compiler: a controller behind a UDP socket, in its own process."""

import socket

import numpy as np

from beamenv.baselines import reference_lqg
from beamenv.task import resolve_task

law = reference_lqg(resolve_task().design.full_plant).in_physical_units()
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.bind(("127.0.0.1", 0))
link.settimeout(5.0)
print(link.getsockname()[1], flush=True)
memory = None
while True:
    content, other = link.recvfrom(1024)
    if not content:
        break  # an empty packet
    asked = np.frombuffer(content)
    volts, memory = law.predict(asked[1:], memory)
    link.sendto(np.concatenate([asked[:1], volts]).tobytes(), other)
