# SPDX-License-Identifier: MIT
"""Read a second of leg angles and rig forces from SIMULATED devices that speak the real bytes.

Usage: .venv/bin/python examples/twins.py
"""

import time

import zebro_lab as zl

with zl.open_devices(zebro="sim", rig="sim") as opened:
    end, samples = time.monotonic() + 1.0, {}
    while time.monotonic() < end:
        for device in opened.devices:
            for sample in device.stream.read(timeout=0.05):
                samples.setdefault(device.name, []).append(sample)
    for name, read in samples.items():
        print(f"{name}: {len(read)} samples, the last {type(read[-1]).__name__}")
print("left: what the devices drive is de-energised")
