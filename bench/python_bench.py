#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""python_bench.py MEASURE_PEER: the Python module beside C++, and how soon Ctrl-C ends a diagnosis.

An image of 1280 x 960 px is measured in turn here and by bench/measure_peer.cpp, in a process of its own. A diagnosis
of a campaign on all cores is interrupted at moments that are spread over its half a minute.
"""

import argparse
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np
from numpy.typing import NDArray

import fidservo

ROUNDS = 41
MOMENTS_S = (0.2, 1.0, 3.0, 6.0, 10.0, 15.0, 20.0, 24.0, 27.0)

CHILD = """
import sys, time, fidservo
rig = fidservo.Rig()
recordings = fidservo.read_recordings(sys.argv[1])
print("ready", flush=True)
try:
    fidservo.diagnose(rig, recordings)
    print("done", flush=True)
except KeyboardInterrupt:
    print(time.monotonic(), flush=True)
"""


def frame(rig: fidservo.Rig, folder: Path) -> NDArray[np.uint8]:
    """What the simulated camera sees at rest."""
    experiment = folder / "look.yaml"
    experiment.write_text("name: look\ncarriage_mm: 61.3\nmacro:\n  - { constant_V: 0, duration_s: 0.05 }\n")
    frames: list[NDArray[np.uint8]] = []
    fidservo.simulate(rig, str(experiment), on_frame=lambda time_ns, image: frames.append(image))
    return frames[0]


def measure(peer_program: str, folder: Path) -> None:
    rig = fidservo.Rig()
    image = frame(rig, folder)
    file = folder / "frame.pgm"
    file.write_bytes(f"P5 {image.shape[1]} {image.shape[0]} 255\n".encode() + image.tobytes())
    with subprocess.Popen(
        [peer_program, rig.file, file], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
    ) as peer:
        assert peer.stdin is not None and peer.stdout is not None
        for mode in ("photograph", "machine"):
            finder = fidservo.TagFinder(rig=rig, photograph=mode == "photograph")
            here_s, there_s = [], []
            for round_ in range(ROUNDS + 1):
                start = time.perf_counter()
                tags = finder.measure(image)
                took_s = time.perf_counter() - start
                peer.stdin.write(mode + "\n")
                words = peer.stdout.readline().split()
                assert len(tags) == int(words[1])
                if round_ > 0:  # the first one warms up
                    here_s.append(took_s)
                    there_s.append(float(words[0]))
            print(
                f"measure, {mode:10}: Python {1e3 * median(here_s):7.3f} ms, C++ {1e3 * median(there_s):7.3f} ms "
                f"(medians of {ROUNDS}, in turn; worst {1e3 * max(here_s):.3f} and {1e3 * max(there_s):.3f}): "
                f"{median(here_s) / median(there_s):.3f} times"
            )
        peer.stdin.close()


def interrupt(folder: Path) -> None:
    effects = ["drive_gain", "heater_gain", "hall_offset"]
    for recording in fidservo.simulate_campaign(fidservo.Rig(), seed=3, effects=effects):
        recording.write(folder / "campaign" / recording.name, fidservo.Rig())
    for moment_s in MOMENTS_S:
        with subprocess.Popen(
            [sys.executable, "-c", CHILD, folder / "campaign"], stdout=subprocess.PIPE, text=True
        ) as child:
            assert child.stdout is not None
            child.stdout.readline()
            time.sleep(moment_s)
            sent_s = time.monotonic()
            child.send_signal(signal.SIGINT)
            answer = child.stdout.readline().strip()
        said = answer if answer == "done" else f"KeyboardInterrupt after {float(answer) - sent_s:.3f} s"
        print(f"Ctrl-C {moment_s:4.1f} s after the beginning: {said}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("peer", help="the program measure_peer")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(options.peer, Path(folder))
        (Path(folder) / "campaign").mkdir()
        interrupt(Path(folder))


if __name__ == "__main__":
    main()
