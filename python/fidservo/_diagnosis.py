# SPDX-License-Identifier: GPL-3.0-or-later
"""What a diagnosis says: the fields of the file that `fidservo diagnose --json` writes (docs/diagnosis.md)."""

import json
from dataclasses import dataclass, field, fields, is_dataclass
from math import nan
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

Verdict = Literal["no-gap", "explained", "partly-explained", "unexplained"]
Ended = Literal["finished", "budget", "interrupted"]


@dataclass(frozen=True)
class Parameter:
    """A number of an effect as fitted, in its unit."""

    name: str
    value: float
    unit: str
    std: float
    """One standard error."""


@dataclass(frozen=True)
class SignalGap:
    """A signal's discrepancy on held-out data, r.m.s., in its unit."""

    signal: str
    unit: str
    before: float
    """Without effects."""
    after: float
    """With the effects found."""
    discrepancy: float
    """The part of `after` that neither the named effects nor noise explain."""
    floor: float
    """The error that a perfect model would leave: noise and quantisation."""


@dataclass(frozen=True)
class BlockProbability:
    """How likely a part of the rig is what the file has wrong, 0 to 1."""

    block: str
    probability: float


@dataclass(frozen=True)
class Support:
    """What speaks for a name; docs/diagnosis.md says what each number is."""

    weight: float
    left_floors: float
    without_floors: float
    gap_alone: float
    gap_after: float
    gap_left: float
    names: float
    halves_apart: float
    at_bound: bool
    leaves_something: bool
    leaves_dependence: bool
    contested: bool


@dataclass(frozen=True)
class FoundEffect:
    """An effect taken into the explanation."""

    effect: str
    block: str
    probability: float
    """That it is there, 0 to 1."""
    support: Support
    parameters: tuple[Parameter, ...]
    indistinguishable_from: tuple[str, ...]
    """Effects that these recordings cannot tell from it."""
    gap_removed: float
    """Share of the gap, 0 to 1, with this effect and those before it."""
    gap_removed_interval: tuple[float, float]
    """At 95 %."""


@dataclass(frozen=True)
class TriedEffect:
    """An effect that was tried alone; shares from 0 to 1."""

    effect: str
    probability: float
    gap_removed: float
    would_show: bool = True
    """Whether the recordings would show it at its typical size; if not, they say nothing of it."""


@dataclass(frozen=True)
class TotalGap:
    """R.m.s. over the signals of error over floor, on held-out data."""

    before: float
    after: float
    floor: float
    removed: float
    """1 - (after^2 - 1) / (before^2 - 1), clipped to 0 .. 1."""


@dataclass(frozen=True)
class Equation:
    """A formula for what no named effect explains."""

    acts_on: str
    """The port, in whose unit it is."""
    formula: str
    variables: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    gap_removed: float
    """Share of what is left without it, 0 to 1."""
    gap_removed_interval: tuple[float, float]
    """At 95 %."""
    gap_removed_of_kinds_left_out: float | None
    """The same where each kind of experiment is predicted from the others; None where there is one kind."""
    text: str
    in_place_of_names: bool
    """Whether it stands for the whole gap rather than for what the named effects leave."""


@dataclass(frozen=True)
class Remainder:
    """What no named effect explains."""

    block: str
    depends_on: tuple[str, ...]
    text: str
    equation: Equation | None


@dataclass(frozen=True)
class ProposedExperiment:
    """The experiment that would tell most."""

    experiment: str
    separates: tuple[str, ...]
    """Effects that it would tell apart."""
    text: str


@dataclass(frozen=True)
class Diagnosis:
    """Where a rig and its simulator disagree, and by which effect."""

    format: Literal["fidservo-diagnosis/1"]
    verdict: Verdict
    ended: Ended
    """finished; or the best that was found until the time was over."""
    signals: tuple[SignalGap, ...]
    where: tuple[BlockProbability, ...]
    """Most likely first."""
    effects: tuple[FoundEffect, ...]
    """Sorted by the gap that each alone would cause, largest first."""
    candidates: tuple[TriedEffect, ...]
    """Every effect that was tried, most likely first."""
    gap: TotalGap
    unexplained: Remainder | None
    next_experiment: ProposedExperiment | None
    notes: tuple[str, ...]
    """What could not be decided, and why."""
    _text: str = field(default="", repr=False, compare=False)

    @classmethod
    def from_json(cls, text: str) -> "Diagnosis":
        """Reads the text that `fidservo diagnose --json` writes; null becomes NaN. Raises ValueError."""
        content = json.loads(text)
        if not isinstance(content, dict) or content.get("format") != "fidservo-diagnosis/1":
            raise ValueError("format: must be fidservo-diagnosis/1")
        return _made(cls, {**content, "_text": text}, "diagnosis")

    def json(self) -> str:
        """The text that it was made from: what `fidservo diagnose --json` writes, to the byte."""
        return self._text


Made = TypeVar("Made")


def _made(kind: type[Made], content: dict[str, Any], place: str) -> Made:
    """A dataclass of a JSON object; what it does not know is passed over."""
    types = get_type_hints(kind)
    values = {}
    for one in fields(kind):
        if one.name not in content:
            raise ValueError(f"{place}: {one.name} is missing")
        values[one.name] = _value(types[one.name], content[one.name], f"{place}.{one.name}")
    return kind(**values)


def _value(kind: Any, content: Any, place: str) -> Any:
    """A field's value of its type, as JSON has it."""
    if get_origin(kind) is UnionType:
        if content is None:
            return None
        (kind,) = (one for one in get_args(kind) if one is not NoneType)
    if kind is float:
        return nan if content is None else float(content)
    if get_origin(kind) is tuple:
        return tuple(_value(get_args(kind)[0], one, f"{place}[{k}]") for k, one in enumerate(content))
    return _made(kind, content, place) if is_dataclass(kind) else content
