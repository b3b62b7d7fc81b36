#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Why does a rig not do what its simulator does? Here the rig is simulated, with a motor that is weaker by a tenth:
the diagnosis is given its recordings and the rig file, and finds what the file does not state."""

import argparse

import fidservo


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", help="a rig file [the reference rig's]")
    parser.add_argument("--recordings", help="a folder of recordings [simulated]")
    parser.add_argument("--effects", default="", help="try these only, A,B,.. [all]")
    parser.add_argument("--effort", type=float, help="what may be searched, s of effort [half a minute by the clock]")
    options = parser.parse_args()

    rig = fidservo.Rig(options.rig)
    if options.recordings:
        recordings = fidservo.read_recordings(options.recordings)
    else:
        recordings = [
            fidservo.simulate(rig, kind, effects=["drive_gain:factor=0.9"], seed=7)
            for kind in ("rest", "macro-pulses", "macro-square")
        ]
    diagnosis = fidservo.diagnose(
        rig,
        recordings,
        effects=[name for name in options.effects.split(",") if name],
        effort_s=options.effort,
        progress=lambda what, share: print(f"  {share:4.0%} {what}"),
    )

    gap = diagnosis.gap
    print(f"{diagnosis.verdict}: the gap was {gap.before:.1f} times the noise and is {gap.after:.2f} times")
    for effect in diagnosis.effects:
        print(f"{effect.effect} ({effect.block}), probability {effect.probability:.2f}")
        for parameter in effect.parameters:
            print(f"  {parameter.name} = {parameter.value:.4g} +- {parameter.std:.2g} {parameter.unit}")
        if effect.indistinguishable_from:
            print(f"  or, by these recordings, as well: {', '.join(effect.indistinguishable_from)}")
    if diagnosis.next_experiment:
        print(diagnosis.next_experiment.text)


if __name__ == "__main__":
    main()
