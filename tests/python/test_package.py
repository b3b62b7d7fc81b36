# SPDX-License-Identifier: GPL-3.0-or-later
"""What comes with the module: types, docstrings, examples, the page of the documentation."""

import doctest
import inspect
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fidservo
from fidservo import _fidservo


def python(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, *map(str, arguments)]
    return subprocess.run(words, check=False, capture_output=True, text=True, cwd=cwd)


def test_every_public_name_has_a_docstring() -> None:
    def bare(owner: type, place: str) -> list[str]:
        names = []
        for name, value in vars(owner).items():
            if name.startswith("_") or not (callable(value) or isinstance(value, property)):
                continue
            if not inspect.getdoc(value):
                names.append(f"{place}.{name}")
        return names

    names = [name for name in fidservo.__all__ if not getattr(fidservo, name).__doc__]
    for name in fidservo.__all__:
        if inspect.isclass(getattr(fidservo, name)):
            names += bare(getattr(fidservo, name), name)
    assert names == []


def test_version_is_the_programs() -> None:
    assert fidservo.__version__.startswith("fidservo 0.")


@pytest.mark.slow
def test_types_are_strict(source: Path, tmp_path: Path) -> None:
    run = python(
        *("-m", "mypy", "--strict", f"--cache-dir={tmp_path}"),
        *sorted((source / "examples/python").glob("*.py")),
        *sorted((source / "tests/python").glob("*.py")),
        *(source / "bench").glob("*.py"),
        Path(fidservo.__file__).parent,
        cwd=tmp_path,
    )
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.slow
def test_stubs_name_what_is_there(tmp_path: Path) -> None:
    """But for what a class of pybind11 is made by, and constructors of classes that have none."""
    allowed = tmp_path / "allowed"
    allowed.write_text("fidservo._fidservo.[A-Za-z]+\nfidservo._fidservo.(Detections?|Recording|Tag).__init__\n")
    run = python("-m", "mypy.stubtest", "--allowlist", allowed, _fidservo.__name__, cwd=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "arguments", "prints"),
    [
        ("01_measure_tag.py", [], "claimed 0.00"),
        ("02_columns.py", [], "90 % after"),
        ("03_diagnose.py", ["--effects", "drive_gain,drive_offset", "--effort", "3"], "drive_gain (macro.drive)"),
        ("04_own_log.py", [], "coulomb_friction: gap removed"),
    ],
)
def test_examples_say_what_they_promise(
    source: Path, tmp_path: Path, name: str, arguments: list[str], prints: str
) -> None:
    run = python(source / "examples/python" / name, *arguments, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert prints in run.stdout


@pytest.mark.slow
def test_page_leads_from_arrays_to_a_diagnosis(
    source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rig: fidservo.Rig
) -> None:
    """The lines of docs/from-python.md that need no other module."""
    page = (source / "docs/from-python.md").read_text()
    text = page[page.index("## ") :]
    run = fidservo.simulate(rig, "macro-pulses", effects=["coulomb_friction"], seed=3)
    log = {"t": 1e-9 * run.time_ns, "u": run["macro_command_V"], "x": 0.05 * run["encoder_count"]}
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my-axis.yaml").write_text(
        "name: my-axis\ntick_s: 0.001\nmacro:\n  travel_mm: [0, 200]\n  command_limit_V: 5.0\n"
        "  velocity_gain_mm_per_s_per_V: 198.84809\n  velocity_pole: 0.95833\n"
        "  dead_zone: { threshold_V: 3.0, offset_V: 0.364, slope: 0.636 }\n  encoder_resolution_mm: 0.05\n"
    )
    parsed = doctest.DocTestParser().get_doctest(text, {**log, "numpy": np}, "from-python.md", None, 0)
    assert len(parsed.examples) >= 5
    report: list[str] = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(parsed, out=report.append)
    assert not report, "".join(report)
