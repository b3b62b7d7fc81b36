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


def test_rig_without_parts_has_none_of_them(tmp_path: Path) -> None:
    file = tmp_path / "axis.yaml"
    file.write_text(
        "name: axis\ntick_s: 0.001\nmacro:\n  travel_mm: [-5, 300]\n  command_limit_V: 10\n"
        "  velocity_gain_mm_per_s_per_V: 170\n  velocity_pole: 0.99\n"
        "  dead_zone: { threshold_V: 0, offset_V: 0, slope: 1 }\n  encoder_resolution_mm: 0.05\n"
        "effects:\n  - { name: drive_offset, offset_V: -0.09 }\n"
    )
    axis = fidservo.Rig(file)
    assert not axis.has_micro
    assert axis.image_size_px is None
    assert axis.tag_side_mm is None
    assert axis.travel_mm == (-5.0, 300.0)
    assert axis.effects == {"drive_offset": {"offset_V": -0.09}}
    assert "micro-steps" not in axis.experiments


def test_wrong_rig_file_raises_one_line(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    file.write_text("name: x\ntick_s: -1\n")
    with pytest.raises(fidservo.InputError, match="rig.yaml:2: tick_s") as error:
        fidservo.Rig(file)
    assert "\n" not in str(error.value)
    assert isinstance(error.value, ValueError)
