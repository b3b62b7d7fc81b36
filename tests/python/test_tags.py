# SPDX-License-Identifier: GPL-3.0-or-later
"""TagFinder, detect and measure."""

import csv
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import fidservo

Image = NDArray[np.uint8]

MASKED: Any = np.ma  # which has no types


@pytest.fixture(scope="module")
def image(rig: fidservo.Rig, tmp_path_factory: pytest.TempPathFactory) -> Image:
    """A frame of the simulated camera, with a tag in its middle."""
    file = tmp_path_factory.mktemp("look") / "look.yaml"
    file.write_text("name: look\ncarriage_mm: 60\nmacro:\n  - { constant_V: 0, duration_s: 0.05 }\n")
    frames: list[Image] = []
    fidservo.simulate(rig, str(file), on_frame=lambda time_ns, frame: frames.append(frame))
    return frames[0]


@pytest.fixture(scope="module")
def cut(image: Image) -> Image:
    """The tag in the middle, alone: a photograph that is searched in no time."""
    return image[280:680, 440:840]


def test_tag_has_its_place_and_covariance(rig: fidservo.Rig, image: Image) -> None:
    tags = fidservo.measure(image, rig=rig, photograph=False)
    assert [tag.tag_id for tag in tags] == sorted(tag.tag_id for tag in tags)
    tag = next(tag for tag in tags if tag.tag_id == 30)  # at 60 mm
    assert tag.family == "tag36h11"
    assert tag.camera_known
    assert tag.covariance_px2.shape == (8, 8)
    np.testing.assert_allclose(tag.covariance_px2, tag.covariance_px2.T, rtol=1e-6, atol=1e-12)
    assert np.linalg.eigvalsh(tag.covariance_px2).max() < 0.01
    assert (np.linalg.eigvalsh(tag.centre_covariance_px2) > 0.0).all()
    np.testing.assert_allclose(tag.centre_px, tag.corners_px.mean(axis=0), atol=0.5)
    np.testing.assert_allclose(tag.blur_px, 0.85, atol=0.15)


def test_detection_is_near_the_measured_tag(cut: Image) -> None:
    (found,), (tag,) = fidservo.detect(cut), fidservo.measure(cut)
    assert found.tag_id == tag.tag_id == 30
    assert not tag.camera_known
    np.testing.assert_allclose(found.corners_px, tag.corners_px, atol=1.0)
    assert found.corrected_bits == 0
    assert found.decision_margin > 50.0


def test_corners_are_those_of_replay(
    program: Callable[..., CompletedProcess[str]], cut: Image, tmp_path: Path
) -> None:
    height, width = cut.shape
    (tmp_path / "frame.pgm").write_bytes(f"P5 {width} {height} 255\n".encode() + cut.tobytes())
    run = program("replay", tmp_path / "frame.pgm", "--out", tmp_path / "tags")
    assert run.returncode == 0, run.stderr
    (row,) = csv.DictReader((tmp_path / "tags/detections.csv").open())
    (tag,) = fidservo.measure(cut)
    corners_px = [[float(row[f"p{k}_{axis} [px]"]) for axis in "xy"] for k in range(4)]
    np.testing.assert_allclose(tag.corners_px, corners_px, atol=5.1e-5)
    assert (int(row["tag_id"]), row["refined"]) == (tag.tag_id, "1")
    first = [float(row[f"p0_{axes} [px^2]"]) for axes in ("xx", "xy", "yy")]
    np.testing.assert_allclose(tag.covariance_px2[[0, 0, 1], [0, 1, 1]], first, rtol=1e-3, atol=1e-9)


def test_memory_layout_does_not_matter(cut: Image) -> None:
    finder = fidservo.TagFinder()
    expected = [tag.corners_px for tag in finder.measure(cut.copy())]
    assert len(expected) == 1
    for same in (cut, np.asfortranarray(cut), cut[:, ::-1].copy()[:, ::-1]):
        np.testing.assert_array_equal([tag.corners_px for tag in finder.measure(same)], expected)


def test_image_of_16_bits_is_measured_in_full_scale(cut: Image) -> None:
    (tag,), (expected,) = fidservo.measure(cut.astype(np.uint16) * 16), fidservo.measure(cut)
    np.testing.assert_allclose(tag.corners_px, expected.corners_px, atol=0.02)


def test_order_of_bytes_does_not_matter(cut: Image) -> None:
    native = cut.astype(np.uint16) * 16
    (tag,), (expected,) = fidservo.measure(native.astype(">u2")), fidservo.measure(native)
    np.testing.assert_array_equal(tag.corners_px, expected.corners_px)


def test_rows_at_odd_bytes_are_read(cut: Image) -> None:
    """A row of an image in a packed record may begin anywhere."""
    rows = np.zeros(cut.shape[0], dtype=[("flag", "u1"), ("row", "<u2", cut.shape[1])])
    rows["row"] = cut.astype(np.uint16) * 16
    (tag,), (expected,) = fidservo.measure(rows["row"]), fidservo.measure(rows["row"].copy())
    np.testing.assert_array_equal(tag.corners_px, expected.corners_px)


def test_mirrored_and_inverted_tags_are_read_where_asked(cut: Image) -> None:
    turned = np.ascontiguousarray(255 - cut[:, ::-1])
    assert not fidservo.detect(turned)
    assert [tag.tag_id for tag in fidservo.detect(turned, mirrored=True, inverted=True)] == [30]


def test_what_is_no_grey_image_is_refused(image: Image) -> None:
    for wrong in (image.astype(float), np.dstack([image] * 3), image[0], image.astype(np.int8)):
        with pytest.raises(TypeError, match="uint8 or uint16 of two dimensions"):
            fidservo.measure(wrong)
    with pytest.raises(TypeError, match="^image: is None; must be an array$"):
        fidservo.detect(None)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="image: has masked pixels"):
        fidservo.detect(MASKED.masked_greater(image, 100))
    with pytest.raises(ValueError, match="no pixel"):
        fidservo.measure(np.zeros((0, 5), np.uint8))
    with pytest.raises(fidservo.InputError, match="16383"):
        fidservo.measure(np.zeros((1, 20_000), np.uint8))


def test_wrong_reading_is_refused() -> None:
    with pytest.raises(fidservo.InputError, match="tag37h11"):
        fidservo.TagFinder(family="tag37h11")
    with pytest.raises(fidservo.InputError, match="border-cells"):
        fidservo.TagFinder(family="tagStandard41h12", border_cells=2)
    for wrong in (-1, 3, 7):
        with pytest.raises(fidservo.InputError, match=f"--border-cells: {wrong}: must be 1 or 2"):
            fidservo.TagFinder(border_cells=wrong)


def test_image_without_tags_has_none() -> None:
    assert fidservo.measure(np.full((100, 100), 128, np.uint8)) == []
    assert fidservo.detect(np.zeros((1, 1), np.uint8)) == []


def test_threads_may_share_a_finder(rig: fidservo.Rig, image: Image) -> None:
    finder = fidservo.TagFinder(rig=rig, photograph=False)
    expected = [tag.corners_px for tag in finder.measure(image)]
    with ThreadPoolExecutor(4) as pool:
        for tags in pool.map(finder.measure, [image] * 8):
            np.testing.assert_array_equal([tag.corners_px for tag in tags], expected)
