# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the Python module share."""

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import fidservo


@pytest.fixture(scope="session")
def rig() -> fidservo.Rig:
    return fidservo.Rig()


@pytest.fixture(scope="session")
def source() -> Path:
    """Top of the repository."""
    return Path(__file__).parents[2]


@pytest.fixture(scope="session")
def program() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs the program `fidservo` of the same build."""

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        words = [os.environ["FIDSERVO_PROGRAM"], *map(str, arguments)]
        return subprocess.run(words, check=False, capture_output=True, text=True)

    return run


@pytest.fixture(scope="session")
def pulses(rig: fidservo.Rig) -> fidservo.Recording:
    """A carriage with a weak motor."""
    return fidservo.simulate(rig, "macro-pulses", effects=["drive_gain:factor=0.9"], seed=5)
