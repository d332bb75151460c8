"""The picture has both rows."""

from PIL import Image

from mmweaver.experiments.zero_shot_pictures import draw
from mmweaver.tasks.generation import generate_window
from mmweaver.tasks.radhar import radhar_recipe


def test_a_picture_is_drawn(tmp_path):
    one = {"jack": generate_window(radhar_recipe(), "jack", 0, 3)}
    draw(one, one, tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size[0] > 300
