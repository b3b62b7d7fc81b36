# SPDX-License-Identifier: GPL-3.0-or-later
"""Macro-micro positioning stages: their recordings, their simulator, their fiducials, and why rig and simulator disagree.

    rig = fidservo.Rig("rig.yaml")
    recordings = fidservo.read_recordings("monday/")
    diagnosis = fidservo.diagnose(rig, recordings)
    print(diagnosis.verdict, [effect.effect for effect in diagnosis.effects])

Positions are in mm, voltages in V, times in s or, as time_ns, in ns on one clock; names carry their units. Errors name
the options of the program `fidservo`, which does the same from a terminal.
"""

from collections.abc import Callable, Iterable
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from fidservo._diagnosis import (
    BlockProbability,
    Diagnosis,
    Equation,
    FoundEffect,
    Parameter,
    ProposedExperiment,
    Remainder,
    SignalGap,
    Support,
    TotalGap,
    TriedEffect,
)
from fidservo._fidservo import (
    USUAL_EFFORT_S,
    BudgetEnded,
    Detection,
    Detections,
    InputError,
    Recording,
    Rig,
    RunFault,
    Tag,
    TagFinder,
    __version__,
    diagnose_to_json,
    draft_map,
    read_recordings,
    simulate,
    simulate_campaign,
)

__all__ = [
    "USUAL_EFFORT_S",
    "BlockProbability",
    "BudgetEnded",
    "Detection",
    "Detections",
    "Diagnosis",
    "Equation",
    "FoundEffect",
    "InputError",
    "Parameter",
    "ProposedExperiment",
    "Recording",
    "Remainder",
    "Rig",
    "RunFault",
    "SignalGap",
    "Support",
    "Tag",
    "TagFinder",
    "TotalGap",
    "TriedEffect",
    "__version__",
    "detect",
    "diagnose",
    "draft_map",
    "measure",
    "read_recordings",
    "simulate",
    "simulate_campaign",
]


def diagnose(
    rig: Rig,
    recordings: Iterable[Recording],
    *,
    effects: Iterable[str] = (),
    without: Iterable[str] = (),
    effects_file: str | PathLike[str] | None = None,
    matters: Iterable[str] = (),
    effort_s: float | None = None,
    progress: Callable[[str, float], object] | None = None,
) -> Diagnosis:
    """Says where recordings of a rig and its simulator disagree, and by which effect: `fidservo diagnose`.

    effects: try these only; none: all.
    without: leave these out, and those that no data tell from them.
    effects_file: effects as formulas (docs/effects.md) that are tried beside the listed ones.
    matters: what may stay unexplained of a signal without being called a gap, as "encoder=20um" or "tag=0.1px".
    effort_s: what it may search, in seconds that are counted by what it predicts, on one core: the same answer on any
        machine. USUAL_EFFORT_S stands for half a minute. None: half a minute by the clock, on all cores, longer for
        recordings of more than ten minutes.
    progress: called a few times a second with what is tried, and how much of the time or the effort is gone, 0 to 1.
        What it raises ends the diagnosis.

    One diagnosis at a time; other threads run meanwhile. Ctrl-C raises KeyboardInterrupt. Raises InputError where nothing
    in the recordings can be judged, BudgetEnded where the end came before anything was predicted.
    """
    text = diagnose_to_json(
        rig,
        recordings,
        effects=list(effects),
        without=list(without),
        effects_file=effects_file,
        matters=list(matters),
        effort_s=effort_s,
        progress=progress,
    )
    return Diagnosis.from_json(text)


def detect(image: ArrayLike, **reading: Any) -> list[Detection]:
    """The fiducials in a grey image: TagFinder(**reading).detect(image)."""
    return TagFinder(**reading).detect(image)


def measure(image: ArrayLike, **reading: Any) -> list[Tag]:
    """The same, measured to some hundredths of a pixel, with their covariance: TagFinder(**reading).measure(image)."""
    return TagFinder(**reading).measure(image)
