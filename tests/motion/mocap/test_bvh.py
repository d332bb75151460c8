"""BVH: places that were put in come out, whatever the order of channels and the line ends; damage is named."""

from pathlib import Path

import numpy as np
import pytest
from mocap_files import walk, write_bvh, y_up

from mmweaver.core.errors import InputError
from mmweaver.motion.mocap.bvh import read_bvh

SMALL = """HIERARCHY
ROOT Bip01 Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT arm
  {
    OFFSET 1 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    { OFFSET 1 0 0 }
  }
}
MOTION
Frames: 2
Frame Time: 0.025
0 0 0 0 0 0 0 0 0
10 0 0 90 0 0 0 90 90"""


def test_a_case_worked_by_hand(tmp_path: Path):
    """Root turned 90 degrees about z, the arm by X then Y, in that order; a bracket on one line, no last line end."""
    (tmp_path / "arm.bvh").write_text(SMALL)
    raw = read_bvh(tmp_path / "arm.bvh")
    assert raw.names == ("Bip01 Hips", "arm", "arm_end")
    assert raw.fps == pytest.approx(40.0)
    np.testing.assert_allclose(raw.positions[0], [(1, 2, 3), (2, 2, 3), (3, 2, 3)], atol=1e-12)
    # arm's x axis: Rx(90) Ry(90) sends x to -z and then to +y; the root's Rz(90) sends +y to -x
    np.testing.assert_allclose(raw.positions[1], [(11, 2, 3), (11, 3, 3), (10, 3, 3)], atol=1e-12)


@pytest.mark.parametrize("order", ["ZXY", "XYZ", "YZX"])
@pytest.mark.parametrize(("end", "last_end"), [("\n", True), ("\r\n", False)])
def test_the_places_of_a_walk_come_back(tmp_path: Path, order: str, end: str, last_end: bool):
    joints = y_up(walk())
    write_bvh(tmp_path / "walk.bvh", joints, order=order, end=end, last_end=last_end)
    raw = read_bvh(tmp_path / "walk.bvh")
    ours = [k for k, name in enumerate(raw.names) if not name.endswith("_end")]
    by_name = {raw.names[k]: raw.positions[:, k] for k in ours}
    assert len(by_name) == 22
    for k, name in enumerate(("pelvis", "left_hip", "right_hip")):
        np.testing.assert_allclose(by_name[name], joints[:, k], atol=1e-6)
    np.testing.assert_allclose(by_name["right_wrist"], joints[:, 21], atol=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("HIERARCHY", "SKELETON"), "does not begin with HIERARCHY"),
        (lambda text: text.split("MOTION")[0], "no MOTION"),
        (lambda text: text[:-3], "cut short"),
        (lambda text: text[: text.rstrip().rindex(" ")], "bad.bvh holds 17 numbers, 2 frames of 9 channels need 18"),
        (lambda text: text.replace("Frames: 2", "Frames: 0"), "no frames"),
        (lambda text: text.replace("Frames: 2\n", ""), "Frames:"),
        (lambda text: text.replace("10 0 0", "10 x 0"), "no number"),
        (lambda text: text.replace("CHANNELS 3", "CHANNELS 4"), "channels"),
        (lambda text: text.replace("}\nMOTION", "MOTION"), "bracket"),
        (lambda text: text.replace("OFFSET 1 2 3", "OFFSET 1 2"), "offset"),
        (lambda text: text.replace("  JOINT arm", "}\nROOT arm"), "several skeletons"),
        (lambda text: text.replace("OFFSET 1 0 0\n", "WEIGHT 3\nOFFSET 1 0 0\n", 1), "not understood"),
    ],
)
def test_what_is_damaged_is_named_in_one_line(tmp_path: Path, change, message: str):
    (tmp_path / "bad.bvh").write_text(change(SMALL))
    with pytest.raises(InputError, match=message) as caught:
        read_bvh(tmp_path / "bad.bvh")
    assert "\n" not in str(caught.value)
