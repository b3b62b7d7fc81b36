# SPDX-License-Identifier: GPL-3.0-or-later
"""Recording: columns without a copy, and recordings out of arrays."""

import gc
from pathlib import Path

import numpy as np
import pytest

import fidservo

MAP = """
format: fidservo-map/1
recording: { name: run-1, rig: reference-rig, experiment: pulses }
time: t [ns]
columns:
  macro_command: u [mV]
  encoder: { signal: x, unit: count }
"""


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
    np.testing.assert_array_equal(again["encoder_count"], pulses["encoder_count"])
    np.testing.assert_allclose(again["macro_command_V"], pulses["macro_command_V"], atol=1e-7)
    np.testing.assert_allclose(again.detections.corners_px, pulses.detections.corners_px, atol=1e-4)
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
    with pytest.raises(TypeError, match="x: must hold numbers"):
        fidservo.Recording.from_arrays({**right, "x": np.array(["a"] * 20)}, MAP)


def test_draft_map_lists_the_arrays() -> None:
    draft = fidservo.draft_map({"t": 0.001 * np.arange(20), "speed": np.arange(20.0)})
    assert "format: fidservo-map/1" in draft
    assert "speed" in draft
