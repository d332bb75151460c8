from pathlib import Path

from PIL import Image

from mmweaver.figures.motion_strip import draw_sheet, draw_strip
from mmweaver.motion.empty_floor import act_out


def test_a_strip_and_a_sheet_are_drawn(tmp_path: Path):
    pose = act_out("a person bows", duration_s=1.5).pose
    draw_strip(pose, tmp_path / "one.png", title="bowing", count=4)
    draw_sheet([("one", pose), ("two", pose), ("three", pose)], tmp_path / "all.png", columns=2, count=3)
    one, many = Image.open(tmp_path / "one.png"), Image.open(tmp_path / "all.png")
    assert one.size[1] < many.size[1]
    assert len(one.convert("RGB").getcolors(1 << 24) or []) > 10, "something is drawn"
