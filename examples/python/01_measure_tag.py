#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fiducials in an image, each with the covariance of its place, and how well it is kept: the camera looks at a plate
at rest, and the scatter of a tag's centre from frame to frame stands beside what is claimed for each frame."""

import numpy as np
from numpy.typing import NDArray

import fidservo


def main() -> None:
    rig = fidservo.Rig()  # the reference rig
    images: list[NDArray[np.uint8]] = []
    fidservo.simulate(rig, "rest", on_frame=lambda time_ns, image: images.append(image))

    finder = fidservo.TagFinder(rig=rig, photograph=False)
    frames = [{tag.tag_id: tag for tag in finder.measure(image)} for image in images]
    tag_id = min(frames[0])
    seen = [frame[tag_id] for frame in frames if tag_id in frame]
    centres_px = np.array([tag.centre_px for tag in seen])
    claimed_px = np.sqrt(np.mean([np.diag(tag.centre_covariance_px2) for tag in seen], axis=0))

    height_px, width_px = images[0].shape
    print(f"{len(images)} images of {width_px} x {height_px} px; tag {tag_id} in {len(seen)} of them")
    for name, centre, scatter, claim in zip("uv", centres_px.mean(axis=0), centres_px.std(axis=0, ddof=1), claimed_px):
        print(f"  {name} = {centre:.3f} px, scatter {scatter:.4f} px, claimed {claim:.4f} px")


if __name__ == "__main__":
    main()
