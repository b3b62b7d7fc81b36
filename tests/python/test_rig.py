# SPDX-License-Identifier: GPL-3.0-or-later
"""Rig."""

from pathlib import Path

import pytest

import fidservo


def test_reference_rig_is_read_without_a_file(rig: fidservo.Rig) -> None:
    assert rig.name == "reference-rig"
    assert rig.tick_s == 0.001
    assert rig.file.name == "rig.yaml"
    assert rig.has_micro
    assert rig.image_size_px == (1280, 960)
    assert "macro-pulses" in rig.experiments


def test_rig_without_parts_has_none_of_them(source: Path, tmp_path: Path) -> None:
    file = tmp_path / "axis.yaml"
    text = (source / "tests/python/axis.yaml").read_text()
    file.write_text(text)
    axis = fidservo.Rig(file)
    assert not axis.has_micro
    assert axis.image_size_px is None
    assert axis.tag_side_mm is None
    assert axis.travel_mm == (0.0, 200.0)
    assert axis.effects == {"cogging": {"amplitude_V": 0.05, "period_mm": 2.0, "phase_deg": 0.0}}


def test_wrong_rig_file_raises_one_line(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    file.write_text("format: fidservo-rig/1\nname: x\ntick_s: -1\n")
    with pytest.raises(fidservo.InputError, match="rig.yaml:3: tick_s") as error:
        fidservo.Rig(file)
    assert "\n" not in str(error.value)
    assert isinstance(error.value, ValueError)
