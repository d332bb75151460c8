"""Crops of photos."""

import numpy as np

from mmweaver.geometry.pinhole import unproject
from mmweaver.scene.sample_photo import sample_photo
from studies.scene.little_floor import CROPS, cropped


def test_a_crop_measures_the_same_points():
    photo, _ = sample_photo()
    for box in CROPS.values():
        part = cropped(photo, box)
        assert part.depth_m.shape == (part.intrinsics.height, part.intrinsics.width)
        top, left = round(box[0] * photo.depth_m.shape[0]), round(box[2] * photo.depth_m.shape[1])
        whole = unproject(photo.depth_m, photo.intrinsics)[top:, left:][
            : part.depth_m.shape[0], : part.depth_m.shape[1]
        ]
        assert np.allclose(unproject(part.depth_m, part.intrinsics), whole, equal_nan=True)
