"""A PI controller for CombBench as a program of its own, with nothing but Python's own library.

combbench run first-look --controller-process "python docs/controllers/pi.py -2 -9"
"""

import struct
import sys

SAMPLE = struct.Struct("<9d")  # begins, tick, time_ms, dt_ms, reference, model, measured, applied, engaged
VOLTAGE = struct.Struct("<d")

kp = float(sys.argv[1]) if len(sys.argv) > 1 else -2.0  # V/um
ki = float(sys.argv[2]) if len(sys.argv) > 2 else -9.0  # V/(um ms)
integral = 0.0

while len(data := sys.stdin.buffer.read(SAMPLE.size)) == SAMPLE.size:
    begins, tick, time_ms, dt_ms, reference, model, measured, applied, engaged = SAMPLE.unpack(data)
    e = model - measured
    if begins:
        integral = 0.0
    if engaged:
        integral += ki * e * dt_ms
    else:  # in shadow: ready to take over from here
        integral = applied - kp * e
    sys.stdout.buffer.write(VOLTAGE.pack(kp * e + integral))
    sys.stdout.buffer.flush()
