# SPDX-License-Identifier: GPL-3.0-or-later
"""Recording: columns without a copy, and recordings out of arrays."""

import gc
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import fidservo

Arrays = dict[str, NDArray[Any]]
Program = Callable[..., CompletedProcess[str]]

MASKED: Any = np.ma  # which has no types

MAP = """
format: fidservo-map/1
recording: { name: run-1, rig: reference-rig, experiment: pulses }
time: t [ns]
columns:
  macro_command: u [mV]
  encoder: { signal: x, unit: count }
"""


def assert_same(recording: fidservo.Recording, expected: fidservo.Recording) -> None:
    """To the last bit."""
    assert recording.columns == expected.columns
    np.testing.assert_array_equal(recording.time_ns, expected.time_ns)
    for column in expected.columns:
        np.testing.assert_array_equal(recording[column], expected[column], column)


def test_columns_are_views_of_one_memory(pulses: fidservo.Recording) -> None:
    first, second = pulses["encoder_count"], pulses["encoder_count"]
    assert first.dtype == np.float64
    assert len(first) == len(pulses) == len(pulses.time_ns)
    assert np.shares_memory(first, second)
    assert first.base is pulses


def test_columns_cannot_be_written(pulses: fidservo.Recording) -> None:
    for column in (pulses["encoder_count"], pulses.time_ns):
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 1


def test_columns_outlive_the_name_of_their_recording(rig: fidservo.Rig) -> None:
    recording = fidservo.simulate(rig, "macro-pulses", seed=5)
    column, corners_px = recording["macro_command_V"], recording.detections.corners_px
    copy, corners_copy_px = column.copy(), corners_px.copy()
    del recording
    gc.collect()
    _ = [np.full(100_000, float(k)) for k in range(50)]
    np.testing.assert_array_equal(column, copy)
    np.testing.assert_array_equal(corners_px, corners_copy_px)


def test_columns_are_those_of_the_rig(pulses: fidservo.Recording) -> None:
    assert pulses.columns == [
        "macro_setpoint_mm",
        "macro_command_V",
        "encoder_count",
        "micro_setpoint_mm",
        "micro_command_V",
        "hall_adc",
    ]
    with pytest.raises(KeyError, match="position_mm"):
        _ = pulses["position_mm"]
    assert np.isnan(pulses["macro_setpoint_mm"]).all()  # pulses are commanded, not followed


def test_detections_are_arrays(pulses: fidservo.Recording) -> None:
    seen = pulses.detections
    assert len(seen) > 10
    assert seen.corners_px.shape == (len(seen), 4, 2)
    assert seen.time_ns.shape == seen.tag_id.shape == (len(seen),)
    assert (np.diff(seen.time_ns) >= 0).all()
    assert seen.covariances_px2.shape == (len(seen), 4, 2, 2)
    assert seen.corners_px.base is not None and not seen.corners_px.flags.writeable


def test_written_recording_is_read_as_it_was(pulses: fidservo.Recording, rig: fidservo.Rig, tmp_path: Path) -> None:
    pulses.write(tmp_path / "run", rig)
    again = fidservo.Recording.read(tmp_path / "run")
    assert (again.name, again.rig, again.experiment) == (pulses.name, pulses.rig, pulses.experiment)
    np.testing.assert_array_equal(again.time_ns, pulses.time_ns)
    assert_same(again, pulses)
    np.testing.assert_array_equal(again.detections.corners_px, pulses.detections.corners_px)
    np.testing.assert_array_equal(again.detections.covariances_px2, pulses.detections.covariances_px2)
    with pytest.raises(fidservo.InputError, match="run"):
        pulses.write(tmp_path / "run", rig)
    assert [one.name for one in fidservo.read_recordings(tmp_path)] == [pulses.name]


def test_recording_that_is_not_there_raises(tmp_path: Path) -> None:
    with pytest.raises(fidservo.InputError, match="recording"):
        fidservo.Recording.read(tmp_path)
    with pytest.raises(fidservo.InputError):
        fidservo.read_recordings(tmp_path)


def test_recording_of_arrays_has_their_numbers(pulses: fidservo.Recording) -> None:
    made = fidservo.Recording.from_arrays(
        {"t": pulses.time_ns, "u": 1e3 * pulses["macro_command_V"], "x": pulses["encoder_count"]}, MAP
    )
    assert (made.name, made.rig, made.experiment, made.tick_s) == ("run-1", "reference-rig", "pulses", 0.001)
    assert made.columns == ["macro_command_V", "encoder_count"]
    np.testing.assert_array_equal(made.time_ns, pulses.time_ns)
    np.testing.assert_array_equal(made["encoder_count"], pulses["encoder_count"])
    np.testing.assert_allclose(made["macro_command_V"], pulses["macro_command_V"], rtol=1e-15)
    assert any("macro_command: u of arrays" in note for note in made.notes)


def test_arrays_of_other_types_are_taken(pulses: fidservo.Recording) -> None:
    made = fidservo.Recording.from_arrays(
        {
            "t": pulses.time_ns[::-1][::-1],
            "u": (1e3 * pulses["macro_command_V"]).astype(np.float32),
            "x": pulses["encoder_count"].astype(np.int32),
        },
        MAP,
    )
    np.testing.assert_array_equal(made["encoder_count"], pulses["encoder_count"])


def test_whole_times_of_64_bits_are_kept_exactly() -> None:
    late_ns = 1_700_000_000_000_000_001 + 1_000_000 * np.arange(20)
    made = fidservo.Recording.from_arrays({"t": late_ns, "u": np.zeros(20), "x": np.arange(20)}, MAP)
    np.testing.assert_array_equal(made.time_ns, late_ns)


def test_whole_times_without_sign_are_kept_exactly() -> None:
    late_ns = 1_700_000_000_000_000_001 + 1_000_000 * np.arange(20)
    for times_ns in (late_ns.astype(np.uint64), late_ns.astype(">u8"), late_ns.astype(">i8")):
        made = fidservo.Recording.from_arrays({"t": times_ns, "u": np.zeros(20), "x": np.arange(20)}, MAP)
        np.testing.assert_array_equal(made.time_ns, late_ns)
    too_late_ns = late_ns.astype(np.uint64) + np.uint64(2**63)
    with pytest.raises(fidservo.InputError, match="t: value 1"):
        fidservo.Recording.from_arrays({"t": too_late_ns, "u": np.zeros(20), "x": np.arange(20)}, MAP)


def test_masked_values_are_missing() -> None:
    volts = MASKED.masked_greater(np.arange(20), 14)
    counts = MASKED.masked_array(np.arange(20), mask=False)
    made = fidservo.Recording.from_arrays({"t": 1_000_000 * np.arange(20), "u": volts, "x": counts}, MAP)
    np.testing.assert_array_equal(np.isnan(made["macro_command_V"]), volts.mask)
    np.testing.assert_array_equal(made["encoder_count"], np.arange(20))


def test_what_numpy_makes_an_array_of_is_taken() -> None:
    class Series:
        def __array__(self, dtype: object = None) -> NDArray[np.float64]:
            return 0.5 * np.arange(20.0)

    class Table:
        """As one of pandas."""

        def keys(self) -> list[str]:
            return ["t", "u", "x"]

        def __getitem__(self, name: str) -> object:
            return {"t": [1_000_000 * k for k in range(20)], "u": Series(), "x": tuple(range(20))}[name]

    made = fidservo.Recording.from_arrays(Table(), MAP)  # type: ignore[arg-type]
    np.testing.assert_array_equal(made["macro_command_V"], 1e-3 * 0.5 * np.arange(20))
    np.testing.assert_array_equal(made["encoder_count"], np.arange(20))


SETPOINT_MAP = """
format: fidservo-map/1
recording: { name: run-1, rig: axis, experiment: steps, unit: '7', camera: v4l2, tick_s: 0.001 }
time: t [ns]
columns:
  macro_setpoint: { signal: r, unit: mm, decimals: 2 }
  macro_command: u [V]
  position: x [mm]
"""


@pytest.fixture
def measured() -> Arrays:
    """Setpoints to 0.01 mm, readings to the last bit."""
    k = np.arange(20)
    return {"t": 1_000_000 * k, "r": np.round(0.11 * k, 2), "u": np.sin(k), "x": np.cos(k)}


def import_by_program(arrays: Arrays, text: str, program: Program, folder: Path, out: str) -> None:
    rows = [",".join(map(repr, row)) for row in zip(*(values.tolist() for values in arrays.values()), strict=True)]
    (folder / "log.csv").write_text("\n".join([",".join(arrays), *rows, ""]))
    (folder / "map.yaml").write_text(text)
    run = program("import", folder / "log.csv", "--map", folder / "map.yaml", "--out", folder / out)
    assert run.returncode == 0, run.stderr


def test_written_recording_is_the_importers_to_the_byte(measured: Arrays, program: Program, tmp_path: Path) -> None:
    made = fidservo.Recording.from_arrays(measured, SETPOINT_MAP)
    made.write(tmp_path / "here")
    assert_same(fidservo.Recording.read(tmp_path / "here"), made)
    import_by_program(measured, SETPOINT_MAP, program, tmp_path, "there")
    for file in ("recording.yaml", "stage0/data.csv"):
        assert (tmp_path / "here" / file).read_bytes() == (tmp_path / "there" / file).read_bytes()
    assert (tmp_path / "here/stage0/data.csv").read_text().splitlines()[2].startswith("1000000,0.11,0.8414709848")


def test_recording_that_was_read_is_written_as_it_was(measured: Arrays, tmp_path: Path) -> None:
    fidservo.Recording.from_arrays(measured, SETPOINT_MAP).write(tmp_path / "first")
    fidservo.Recording.read(tmp_path / "first").write(tmp_path / "second")
    for file in ("recording.yaml", "stage0/data.csv"):
        assert (tmp_path / "second" / file).read_bytes() == (tmp_path / "first" / file).read_bytes()


def test_setpoint_is_as_exact_as_in_the_importers_folder(
    rig: fidservo.Rig, program: Program, tmp_path: Path
) -> None:
    """The controller that is replayed may have come to any count of what rounds to a setpoint."""
    (tmp_path / "step.yaml").write_text(
        "name: step\ncarriage_mm: 60\nmacro:\n  - { constant_mm: 60.13, duration_s: 0.2 }\n"
        "  - { constant_mm: 62.17, duration_s: 0.3 }\n"
    )
    run = fidservo.simulate(rig, str(tmp_path / "step.yaml"), seed=2)
    text = (
        "format: fidservo-map/1\n"
        "recording: { name: run-1, rig: reference-rig, experiment: step, tick_s: 0.001,\n"
        "  controllers: { macro: nonlinear_pd }, encoder_zero: { count: 0, std_count: 0 } }\n"
        "time: t [ns]\n"
        "columns:\n"
        "  macro_setpoint: { signal: r, unit: mm, decimals: 1 }\n"
        "  macro_command: u [V]\n"
        "  encoder: x [count]\n"
    )
    arrays = {"t": run.time_ns, "u": run["macro_command_V"], "x": run["encoder_count"]}
    arrays["r"] = np.round(run["macro_setpoint_mm"], 1)
    import_by_program(arrays, text, program, tmp_path, "imported")
    made = fidservo.Recording.from_arrays(arrays, text)
    read = fidservo.Recording.read(tmp_path / "imported")
    answers = {fidservo.diagnose(rig, [one], effects=["drive_gain"], effort_s=0.1).json() for one in (made, read)}
    assert len(answers) == 1


def test_wrong_arrays_and_maps_raise_one_line() -> None:
    right = {"t": 1_000_000 * np.arange(20), "u": np.zeros(20), "x": np.zeros(20)}
    with pytest.raises(fidservo.InputError, match="x: there is no such signal"):
        fidservo.Recording.from_arrays({"t": right["t"], "u": right["u"]}, MAP)
    with pytest.raises(fidservo.InputError, match="format"):
        fidservo.Recording.from_arrays(right, "format: something-else\n")
    with pytest.raises(fidservo.InputError, match="times do not rise"):
        fidservo.Recording.from_arrays({**right, "t": right["t"][::-1]}, MAP)
    with pytest.raises(ValueError, match="x: has 2 dimensions"):
        fidservo.Recording.from_arrays({**right, "x": np.zeros((20, 2))}, MAP)
    for wrong, says in (
        (np.array(["a"] * 20), "x: holds <U1; must hold numbers"),
        ([1.0, None], "x: holds object; must hold numbers"),
        (None, "x: is None; must be an array"),
        ([[1, 2], [3]], "x: must be an array, not list: .*"),
    ):
        with pytest.raises(TypeError, match=f"^{says}$"):
            fidservo.Recording.from_arrays({**right, "x": wrong}, MAP)  # type: ignore[dict-item]
    with pytest.raises(TypeError, match="^map: must be the text of a map, not dict$"):
        fidservo.Recording.from_arrays(right, {"format": "fidservo-map/1"})  # type: ignore[arg-type]
    for none, says in ((None, "NoneType"), ([1, 2], "list"), ("t", "str")):
        with pytest.raises(TypeError, match=f"^arrays: must be a dict of arrays by name, not {says}$"):
            fidservo.Recording.from_arrays(none, MAP)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="^arrays: must be a dict of arrays by name; has the name 5$"):
        fidservo.draft_map({5: np.zeros(20)})  # type: ignore[dict-item]


def test_draft_map_lists_the_arrays() -> None:
    draft = fidservo.draft_map({"t": 0.001 * np.arange(20), "speed": np.arange(20.0)})
    assert "format: fidservo-map/1" in draft
    assert "speed" in draft
