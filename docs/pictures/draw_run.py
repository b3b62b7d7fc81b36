#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws an inspection run as a picture that moves: docs/pictures/run.svg.

    fidservo inspect assets/demo/recipe.yaml --out RUN
    docs/pictures/draw_run.py RUN docs/pictures/run.svg

Everything is from the run's own files: the carriage's way from the recordings' encoder, the verdicts and their times from
run.json, the camera's images as they were saved. Needs python3-pil.
"""
import base64
import csv
import io
import json
import sys
from pathlib import Path

from PIL import Image

ENCODER_MM = 0.05
TAG_PITCH_MM = 2.0
WIDTH, HEIGHT = 860, 300
LEFT, RIGHT, RAIL_Y = 40, 820, 92
TRAVEL_MM = 200.0
VERDICTS = {"pass": "#2e7d32", "fail": "#c62828"}


def x_px(place_mm: float) -> float:
    return LEFT + (RIGHT - LEFT) * place_mm / TRAVEL_MM


def carriage(run: Path, step: int = 40) -> list[tuple[float, float]]:
    """Time in s and place in mm relative to the first reading, of every step-th tick of all visits."""
    rows: list[tuple[float, float]] = []
    for folder in sorted((run / "recordings").glob("site-*")):
        with (folder / "stage0" / "data.csv").open() as file:
            for k, row in enumerate(csv.reader(file)):
                if k % step == 1:
                    rows.append((float(row[0]) * 1e-9, float(row[3]) * ENCODER_MM))
    return sorted(rows)


def thumbnail(file: Path) -> str:
    image = Image.open(file).convert("L")
    image.thumbnail((170, 130))
    out = io.BytesIO()
    image.save(out, "JPEG", quality=70)
    return "data:image/jpeg;base64," + base64.b64encode(out.getvalue()).decode()


def animated(attribute: str, values: list[tuple[float, float]], begin_s: float, length_s: float) -> str:
    times = [min(1.0, max(0.0, (t - begin_s) / length_s)) for t, _ in values]
    times[0], times[-1] = 0.0, 1.0
    return (
        f'<animate attributeName="{attribute}" dur="{length_s / 2:.2f}s" repeatCount="indefinite" '
        f'keyTimes="{";".join(f"{t:.4f}" for t in times)}" values="{";".join(f"{v:.1f}" for _, v in values)}"/>'
    )


def failures(run: Path) -> dict[int, list[str]]:
    """What failed at each site, a line a feature."""
    found: dict[int, list[str]] = {}
    with (run / "results.csv").open() as file:
        for row in csv.DictReader(file):
            if row["verdict"] == "fail":
                value = f"{float(row['value']):.3f} {row['unit']}" if row["value"] else "not found"
                said = f"{row['feature'].split('@')[0]}: {row['check'].replace('_', ' ')} {value}"
                found.setdefault(int(row["site"]), []).append(said)
    return found


def shown(begin: float, end: float) -> str:
    """Visible from begin to end, as shares of the whole."""
    return (
        f'<animate attributeName="opacity" dur="{{dur}}" repeatCount="indefinite" calcMode="discrete" '
        f'keyTimes="0;{begin:.4f};{end:.4f}" values="0;1;0"/>'
    )


def main(run: Path, out: Path) -> None:
    summary = json.loads((run / "run.json").read_text())
    visits, failed = summary["visits"], failures(run)
    way = carriage(run)
    begin_s, end_s = way[0][0], way[-1][0] + 2.0
    length_s = end_s - begin_s
    # The camera is at its first site when that visit ends.
    zero_mm = TAG_PITCH_MM * visits[0]["site"] - [place for t, place in way if t <= visits[0]["to_s"]][-1]
    places = [(t, x_px(zero_mm + place)) for t, place in way] + [(end_s, x_px(zero_mm + way[-1][1]))]
    dur = f"{length_s / 2:.2f}s"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
        "<!-- SPDX-License-Identifier: GPL-3.0-or-later; drawn by docs/pictures/draw_run.py -->",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fafafa"/>',
        '<text x="40" y="26" font-size="15" fill="#222">fidservo inspect: sixteen sites of the demo plate, twice as fast as they were</text>',
        f'<rect x="{LEFT}" y="{RAIL_Y - 4}" width="{RIGHT - LEFT}" height="8" rx="4" fill="#b0bec5"/>',
        f'<text x="{LEFT}" y="{RAIL_Y + 66}" fill="#555">0</text>',
        f'<text x="{RIGHT - 50}" y="{RAIL_Y + 66}" fill="#555">200 mm</text>',
    ]
    for visit in visits:
        place, end = x_px(TAG_PITCH_MM * visit["site"]), (visit["to_s"] - begin_s) / length_s
        parts.append(f'<circle cx="{place:.1f}" cy="{RAIL_Y + 40}" r="8" fill="#cfd8dc"/>')
        parts.append(
            f'<circle cx="{place:.1f}" cy="{RAIL_Y + 40}" r="8" fill="{VERDICTS.get(visit["verdict"], "#f9a825")}" opacity="0">'
            + shown(end, 1.0).format(dur=dur)
            + "</circle>"
        )
    parts.append(
        f'<rect y="{RAIL_Y - 22}" width="44" height="30" rx="5" fill="#37474f">'
        + animated("x", [(t, x - 22.0) for t, x in places], begin_s, length_s)
        + "</rect>"
    )
    parts.append(
        f'<polygon fill="#1565c0" opacity="0.25" points="0,0 -14,32 14,32" transform="translate(0 {RAIL_Y + 6})">'
        f'<animateTransform attributeName="transform" type="translate" dur="{dur}" repeatCount="indefinite" '
        f'keyTimes="{";".join(f"{min(1.0, max(0.0, (t - begin_s) / length_s)) if 0 < k < len(places) - 1 else (0.0 if k == 0 else 1.0):.4f}" for k, (t, _) in enumerate(places))}" '
        f'values="{";".join(f"{x:.1f} {RAIL_Y + 6}" for _, x in places)}"/></polygon>'
    )
    for visit in visits:
        name = f"site-{visit['site']:03}" + ("-again" if visit["again"] else "")
        begin, end = (visit["from_s"] - begin_s) / length_s, (visit["to_s"] - begin_s) / length_s
        colour = VERDICTS.get(visit["verdict"], "#f9a825")
        images = "".join(
            f'<image x="{x}" y="170" width="150" height="113" href="{thumbnail(run / "images" / f"{name}-{view}.png")}"/>'
            for x, view in ((40, "left"), (200, "right"))
        )
        said = [f"site {visit['site']}: {visit['verdict']}, {visit['checks']} checks", *failed.get(visit["site"], [])[:2]]
        text = "".join(f'<text x="375" y="{198 + 22 * k}" fill="{colour}">{line}</text>' for k, line in enumerate(said))
        parts.append(f'<g opacity="0">{images}{text}{shown(max(begin, 0.0001), min(end, 0.9999)).format(dur=dur)}</g>')
    parts.append(
        '<text x="375" y="266" fill="#555">macro: a printer carriage over 200 mm; micro: a wire-driven platform</text>'
        '<text x="375" y="283" fill="#555">that the fiducials in the image bring to its place</text></svg>'
    )
    out.write_text("\n".join(parts) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: draw_run.py RUN OUT.svg")
    main(Path(sys.argv[1]), Path(sys.argv[2]))
