#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A log of one's own, as arrays, made a recording by a map that says what each array is and in which unit; then the
diagnosis is asked what kind of friction the axis has that its rig file does not state."""

import numpy as np
from numpy.typing import NDArray

import fidservo

MAP = """
format: fidservo-map/1
recording: { name: run-1, rig: reference-rig, experiment: pulses }
time: t [s]
columns:
  macro_command: u [mV]
  encoder: { signal: x, unit: m, factor: 20000 }  # counts per m
"""


def own_log() -> dict[str, NDArray[np.float64]]:
    """Stands for a logger."""
    run = fidservo.simulate(fidservo.Rig(), "macro-pulses", effects=["coulomb_friction"], seed=3)
    return {
        "t": 1e-9 * run.time_ns,
        "u": 1e3 * run["macro_command_V"],
        "x": 5e-5 * run["encoder_count"],
    }


def main() -> None:
    log = own_log()
    print(fidservo.draft_map(log))  # what is there, and a map to begin with
    recording = fidservo.Recording.from_arrays(log, MAP)
    for note in recording.notes:
        print(note)

    diagnosis = fidservo.diagnose(
        fidservo.Rig(), [recording], effects=["coulomb_friction", "viscous_friction", "drive_gain"], effort_s=3.0
    )
    print(f"{diagnosis.verdict}: {diagnosis.gap.before:.1f} times the noise, {diagnosis.gap.after:.2f} times")
    for effect in diagnosis.effects:
        print(f"  {effect.effect}: gap removed {effect.gap_removed:.1%}")


if __name__ == "__main__":
    main()
