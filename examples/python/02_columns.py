#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A recording's columns as arrays: how well the carriage follows a square wave, from the recording alone."""

import sys

import numpy as np

import fidservo


def main() -> None:
    rig = fidservo.Rig()
    if len(sys.argv) > 1:
        recording = fidservo.Recording.read(sys.argv[1])
    else:
        recording = fidservo.simulate(rig, "macro-square", seed=1)

    time_s = 1e-9 * recording.time_ns
    setpoint_mm = recording["macro_setpoint_mm"]
    position_mm = rig.encoder_resolution_mm * recording["encoder_count"]
    steps = np.flatnonzero(np.abs(np.diff(setpoint_mm)) > 1.0) + 1  # NaN: no setpoint is in force

    print(f"{recording!r}: {', '.join(recording.columns)}")
    for first, last in zip(steps, [*steps[1:], len(recording)]):
        size_mm = setpoint_mm[first] - setpoint_mm[first - 1]
        moved_mm = (position_mm[first:last] - position_mm[first]) * np.sign(size_mm)
        risen = np.flatnonzero(moved_mm >= 0.9 * abs(size_mm))
        rise_ms = 1e3 * (time_s[first + risen[0]] - time_s[first]) if risen.size else np.nan
        overshoot_mm = max(0.0, moved_mm.max() - abs(size_mm))
        step = f"at {time_s[first]:6.3f} s by {size_mm:+7.2f} mm"
        print(f"  {step}: 90 % after {rise_ms:5.0f} ms, overshoot {overshoot_mm:.2f} mm")


if __name__ == "__main__":
    main()
