# SPDX-License-Identifier: GPL-3.0-or-later
"""simulate and simulate_campaign."""

from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
from numpy.typing import NDArray

import fidservo

Program = Callable[..., CompletedProcess[str]]


def test_recording_is_the_programs_to_the_byte(rig: fidservo.Rig, program: Program, tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    fidservo.simulate(rig, "micro-steps", effects=["heater_gain:factor=1.05"], seed=9).write(here, rig)
    run = program("simulate", "micro-steps", "--effect", "heater_gain:factor=1.05", "--seed", 9, "--out", there)
    assert run.returncode == 0, run.stderr
    for file in ("stage0/data.csv", "cam0/detections.csv", "cam0/sensor.yaml"):
        assert (here / file).read_bytes() == (there / file).read_bytes()


def test_same_seed_gives_the_same_numbers(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    again = fidservo.simulate(rig, "macro-pulses", effects=["drive_gain:factor=0.9"], seed=5)
    other = fidservo.simulate(rig, "macro-pulses", effects=["drive_gain:factor=0.9"], seed=6)
    np.testing.assert_array_equal(again["encoder_count"], pulses["encoder_count"])
    assert not np.array_equal(other["macro_command_V"], pulses["macro_command_V"])


def test_experiment_file_is_run(rig: fidservo.Rig, tmp_path: Path) -> None:
    file = tmp_path / "push.yaml"
    file.write_text("name: push\ncarriage_mm: 60\nmacro:\n  - { constant_V: 4, duration_s: 0.2 }\n")
    recording = fidservo.simulate(rig, str(file))
    assert recording.experiment == "push"
    assert len(recording) == 200


def test_wrong_words_raise(rig: fidservo.Rig) -> None:
    with pytest.raises(fidservo.InputError, match="macro-pulse"):
        fidservo.simulate(rig, "macro-pulse")
    with pytest.raises(fidservo.InputError, match="FILE.yaml; simulate_campaign makes all$") as error:
        fidservo.simulate(rig, "campaign")
    assert ", campaign" not in str(error.value)
    with pytest.raises(fidservo.InputError, match="no_such_effect"):
        fidservo.simulate(rig, "rest", effects=["no_such_effect"])
    with pytest.raises(fidservo.InputError, match="factor"):
        fidservo.simulate(rig, "rest", effects=["drive_gain:factor=9"])
    with pytest.raises(TypeError):
        fidservo.simulate(rig, 5)  # type: ignore[arg-type]


def test_what_on_frame_raises_ends_the_simulation(rig: fidservo.Rig) -> None:
    class Enough(Exception):
        pass

    times_ns: list[int] = []

    def look(time_ns: int, image: NDArray[np.uint8]) -> None:
        times_ns.append(time_ns)
        if len(times_ns) == 3:
            raise Enough

    with pytest.raises(Enough):
        fidservo.simulate(rig, "rest", on_frame=look)
    assert len(times_ns) == 3


def test_frames_are_those_in_which_fiducials_were_found(rig: fidservo.Rig, tmp_path: Path) -> None:
    file = tmp_path / "look.yaml"
    file.write_text("name: look\ncarriage_mm: 60\nmacro:\n  - { constant_V: 0, duration_s: 0.1 }\n")
    frames: dict[int, NDArray[np.uint8]] = {}
    recording = fidservo.simulate(rig, str(file), on_frame=frames.__setitem__)
    assert set(recording.detections.time_ns) <= set(frames)
    image = frames[int(recording.detections.time_ns[0])]
    assert image.shape == (960, 1280)
    assert image.dtype == np.uint8
    tags = fidservo.measure(image, rig=rig, photograph=False)
    first = recording.detections.time_ns == recording.detections.time_ns[0]
    np.testing.assert_allclose(tags[0].corners_px, recording.detections.corners_px[first][0], atol=0.05)


@pytest.mark.slow
def test_campaign_is_two_of_each(rig: fidservo.Rig) -> None:
    names = [recording.name for recording in fidservo.simulate_campaign(rig, seed=2)]
    assert names == sorted(names, key=lambda name: [kind in name for kind in rig.experiments], reverse=True)
    assert len(names) == 2 * len(rig.experiments)
