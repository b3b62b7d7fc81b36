# SPDX-License-Identifier: GPL-3.0-or-later
"""diagnose, and what it answers."""

import json
import math
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import pytest

import fidservo

FEW = ["drive_gain", "coulomb_friction", "drive_offset"]


@pytest.fixture(scope="module")
def quick(rig: fidservo.Rig, pulses: fidservo.Recording) -> fidservo.Diagnosis:
    return fidservo.diagnose(rig, [pulses], effects=FEW, effort_s=1.0)


def test_weak_motor_is_found(quick: fidservo.Diagnosis) -> None:
    assert quick.verdict == "explained"
    (found,) = quick.effects
    assert found.effect == "drive_gain"
    (factor,) = found.parameters
    assert (factor.name, factor.unit) == ("factor", "")
    assert abs(factor.value - 0.9) < max(0.005, 4.0 * factor.std)
    assert found.gap_removed_interval[0] <= found.gap_removed <= found.gap_removed_interval[1]
    assert {one.effect for one in quick.candidates} == set(FEW)


def keys_unlike_fields(value: Any, content: Any, place: str = "") -> list[str]:
    """Where a plain object has other fields than its JSON."""
    if isinstance(value, tuple):
        lists = [keys_unlike_fields(one, other, f"{place}[{k}]") for k, (one, other) in enumerate(zip(value, content))]
        return [line for lines in lists for line in lines]
    if not is_dataclass(value):
        same = value == content or (content is None and (value is None or math.isnan(value)))
        return [] if same else [f"{place}: {value!r} is not {content!r}"]
    names = [field.name for field in fields(value) if not field.name.startswith("_")]
    lines = [] if names == list(content) else [f"{place}: {names} are not {list(content)}"]
    for name in names:
        lines += keys_unlike_fields(getattr(value, name), content.get(name), f"{place}.{name}")
    return lines


def test_plain_objects_have_every_field_of_the_json(quick: fidservo.Diagnosis) -> None:
    assert keys_unlike_fields(quick, json.loads(quick.json())) == []
    assert fidservo.Diagnosis.from_json(quick.json()) == quick


def test_what_is_not_always_there_is_read_too(quick: fidservo.Diagnosis) -> None:
    content = json.loads(quick.json())
    parameter = {"name": "c", "value": 1.5, "unit": "V", "std": None}
    content["unexplained"] = {
        "block": "macro.friction",
        "depends_on": ["velocity"],
        "text": "something is left",
        "equation": {
            "acts_on": "macro.friction",
            "formula": "c * speed",
            "variables": ["speed"],
            "parameters": [parameter],
            "gap_removed": 0.5,
            "gap_removed_interval": [0.4, 0.6],
            "gap_removed_of_kinds_left_out": None,
            "text": "a formula",
            "in_place_of_names": False,
        },
    }
    content["next_experiment"] = {"experiment": "macro-sweep", "separates": ["a", "b"], "text": "Record it."}
    content["of_a_later_version"] = 1
    diagnosis = fidservo.Diagnosis.from_json(json.dumps(content))
    del content["of_a_later_version"]
    assert keys_unlike_fields(diagnosis, content) == []
    assert diagnosis.unexplained is not None and diagnosis.unexplained.equation is not None
    assert math.isnan(diagnosis.unexplained.equation.parameters[0].std)


def test_other_json_is_refused() -> None:
    with pytest.raises(ValueError, match="format"):
        fidservo.Diagnosis.from_json('{"format": "fidservo-fleet/1"}')
    with pytest.raises(ValueError, match="diagnosis: verdict is missing"):
        fidservo.Diagnosis.from_json('{"format": "fidservo-diagnosis/1"}')


def test_same_effort_gives_the_same_text(
    rig: fidservo.Rig, pulses: fidservo.Recording, quick: fidservo.Diagnosis
) -> None:
    assert fidservo.diagnose(rig, [pulses], effects=FEW, effort_s=1.0).json() == quick.json()


def test_progress_is_told(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    told: list[tuple[str, float]] = []
    fidservo.diagnose(rig, [pulses], effects=FEW, effort_s=1.0, progress=lambda what, share: told.append((what, share)))
    assert told
    assert all(what and 0.0 <= share <= 1.0 for what, share in told)


def test_what_progress_raises_ends_the_diagnosis(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    def fail(what: str, share: float) -> None:
        raise ZeroDivisionError(what)

    with pytest.raises(ZeroDivisionError):
        fidservo.diagnose(rig, [pulses], progress=fail)


def test_too_little_effort_is_said(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    assert fidservo.diagnose(rig, [pulses], effects=FEW, effort_s=1e-6).ended == "budget"
    for wrong in (0.0, -1.0, math.nan):
        with pytest.raises(fidservo.InputError, match="effort"):
            fidservo.diagnose(rig, [pulses], effort_s=wrong)


def test_wrong_words_raise(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    with pytest.raises(fidservo.InputError, match="no_such_effect"):
        fidservo.diagnose(rig, [pulses], effects=["no_such_effect"])
    with pytest.raises(fidservo.InputError, match="matters"):
        fidservo.diagnose(rig, [pulses], matters=["encoder"])
    with pytest.raises(fidservo.InputError):
        fidservo.diagnose(rig, [])


def test_what_is_no_list_of_recordings_raises_one_line(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    for wrong, says in (
        ([pulses, None], r"recordings\[1\]: must be a Recording, not NoneType"),
        (["run-1"], r"recordings\[0\]: must be a Recording, not str"),
        (None, "recordings: must be a list of Recordings, not NoneType"),
        (pulses, "recordings: must be a list of Recordings, not Recording"),
    ):
        with pytest.raises(TypeError, match=f"^{says}$"):
            fidservo.diagnose(rig, wrong)  # type: ignore[arg-type]


def test_one_diagnosis_at_a_time(rig: fidservo.Rig, pulses: fidservo.Recording) -> None:
    raised: list[BaseException] = []

    def again(what: str, share: float) -> None:
        def try_it() -> None:
            try:
                fidservo.diagnose(rig, [pulses], effects=FEW, effort_s=1.0)
            except RuntimeError as error:
                raised.append(error)

        thread = threading.Thread(target=try_it)
        thread.start()
        thread.join()

    fidservo.diagnose(rig, [pulses], effects=FEW, effort_s=1.0, progress=again)
    assert raised and "one at a time" in str(raised[0])


@pytest.mark.slow
def test_ctrl_c_raises_keyboard_interrupt() -> None:
    code = """
import sys, fidservo
rig = fidservo.Rig()
recordings = [fidservo.simulate(rig, kind, seed=1, effects=["drive_gain"]) for kind in ("macro-pulses", "micro-steps")]
try:
    fidservo.diagnose(rig, recordings, progress=lambda what, share: print(what, flush=True))
except KeyboardInterrupt:
    sys.exit(42)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=os.environ) as child:
        assert child.stdout is not None
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        child.stdout.read()
    assert child.returncode == 42


@pytest.mark.slow
def test_answer_is_the_programs_to_the_byte(
    rig: fidservo.Rig, program: Callable[..., CompletedProcess[str]], tmp_path: Path
) -> None:
    """By effort, as `fleet diagnose` counts it, on recordings that were written and read."""
    for kind in ("macro-pulses", "micro-steps"):
        recording = fidservo.simulate(rig, kind, effects=["heater_gain:factor=1.05", "drive_gain:factor=0.95"], seed=4)
        recording.write(tmp_path / "unit" / kind, rig)
    run = program("fleet", "diagnose", "--rig", rig.file, tmp_path / "unit", "--effort", 2, "--out", tmp_path / "fleet")
    assert run.returncode == 0, run.stderr
    (file,) = (tmp_path / "fleet").rglob("*unit*.json")
    diagnosis = fidservo.diagnose(rig, fidservo.read_recordings(tmp_path / "unit"), effort_s=2.0)
    assert json.loads(diagnosis.json()) == json.loads(file.read_text())["diagnosis"]
