# SPDX-License-Identifier: GPL-3.0-or-later
"""TagFinder, detect and measure."""

import csv
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
from numpy.typing import NDArray

import fidservo

Image = NDArray[np.uint8]


@pytest.fixture(scope="module")
def image(rig: fidservo.Rig, tmp_path_factory: pytest.TempPathFactory) -> Image:
    """A frame of the simulated camera."""
    file = tmp_path_factory.mktemp("look") / "look.yaml"
    file.write_text("name: look\ncarriage_mm: 60\nmacro:\n  - { constant_V: 0, duration_s: 0.05 }\n")
    frames: list[Image] = []
    fidservo.simulate(rig, str(file), on_frame=lambda time_ns, frame: frames.append(frame))
    return frames[0]


def test_tag_has_its_place_and_covariance(rig: fidservo.Rig, image: Image) -> None:
    tags = fidservo.measure(image, rig=rig)
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


def test_detection_is_near_the_measured_tag(rig: fidservo.Rig, image: Image) -> None:
    found = {tag.tag_id: tag for tag in fidservo.detect(image, rig=rig)}
    for tag in fidservo.measure(image, rig=rig):
        np.testing.assert_allclose(found[tag.tag_id].corners_px, tag.corners_px, atol=1.0)
        assert found[tag.tag_id].corrected_bits == 0
        assert found[tag.tag_id].decision_margin > 50.0


def test_corners_are_those_of_replay(
    rig: fidservo.Rig, program: Callable[..., CompletedProcess[str]], image: Image, tmp_path: Path
) -> None:
    height, width = image.shape
    (tmp_path / "frame.pgm").write_bytes(f"P5 {width} {height} 255\n".encode() + image.tobytes())
    run = program("replay", tmp_path / "frame.pgm", "--rig", rig.file, "--out", tmp_path / "tags")
    assert run.returncode == 0, run.stderr
    rows = list(csv.DictReader((tmp_path / "tags/detections.csv").open()))
    measured = {tag.tag_id: tag for tag in fidservo.measure(image, rig=rig)}
    assert [int(row["tag_id"]) for row in rows if row["refined"] == "1"] == list(measured)
    for row in rows:
        if row["refined"] == "1":
            corners_px = [[float(row[f"p{k}_{axis} [px]"]) for axis in "xy"] for k in range(4)]
            np.testing.assert_allclose(measured[int(row["tag_id"])].corners_px, corners_px, atol=5.1e-5)


def test_memory_layout_does_not_matter(rig: fidservo.Rig, image: Image) -> None:
    finder = fidservo.TagFinder(rig=rig)
    expected = [tag.corners_px for tag in finder.measure(image)]
    wide = np.zeros((image.shape[0], 2 * image.shape[1]), np.uint8)
    wide[:, : image.shape[1]] = image
    for same in (wide[:, : image.shape[1]], np.asfortranarray(image), image[:, ::-1].copy()[:, ::-1]):
        np.testing.assert_array_equal([tag.corners_px for tag in finder.measure(same)], expected)


def test_image_of_16_bits_is_measured_in_full_scale(rig: fidservo.Rig, image: Image) -> None:
    twelve_bits = image.astype(np.uint16) * 16
    tags, expected = (fidservo.measure(one, rig=rig) for one in (twelve_bits, image))
    for tag, other in zip(tags, expected, strict=True):
        np.testing.assert_allclose(tag.corners_px, other.corners_px, atol=0.02)


def test_mirrored_and_inverted_tags_are_read_where_asked(image: Image) -> None:
    turned = np.ascontiguousarray(255 - image[:, ::-1])
    assert not fidservo.detect(turned)
    assert {tag.tag_id for tag in fidservo.detect(turned, mirrored=True, inverted=True)} == {
        tag.tag_id for tag in fidservo.detect(image)
    }


def test_what_is_no_grey_image_is_refused(image: Image) -> None:
    for wrong in (image.astype(float), np.dstack([image] * 3), image[0], image.astype(np.int8)):
        with pytest.raises(TypeError, match="uint8 or uint16 of two dimensions"):
            fidservo.measure(wrong)
    with pytest.raises(ValueError, match="no pixel"):
        fidservo.measure(np.zeros((0, 5), np.uint8))
    with pytest.raises(fidservo.InputError, match="16383"):
        fidservo.measure(np.zeros((1, 20_000), np.uint8))


def test_wrong_reading_is_refused() -> None:
    with pytest.raises(fidservo.InputError, match="tag37h11"):
        fidservo.TagFinder(family="tag37h11")
    with pytest.raises(fidservo.InputError, match="border-cells"):
        fidservo.TagFinder(family="tagStandard41h12", border_cells=2)


def test_image_without_tags_has_none() -> None:
    assert fidservo.measure(np.full((100, 100), 128, np.uint8)) == []
    assert fidservo.detect(np.zeros((1, 1), np.uint8)) == []


def test_threads_may_share_a_finder(rig: fidservo.Rig, image: Image) -> None:
    finder = fidservo.TagFinder(rig=rig, photograph=False)
    expected = [tag.corners_px for tag in finder.measure(image)]
    with ThreadPoolExecutor(4) as pool:
        for tags in pool.map(finder.measure, [image] * 8):
            np.testing.assert_array_equal([tag.corners_px for tag in tags], expected)
