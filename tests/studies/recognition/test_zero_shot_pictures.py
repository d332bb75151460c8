"""The picture has both rows."""

from PIL import Image

from studies.recognition.zero_shot_pictures import draw
from studies.recognition.zero_shot_recipe import generate_window, radhar_recipe


def test_a_picture_is_drawn(tmp_path):
    one = {"jack": generate_window(radhar_recipe(), "jack", 0, 3)}
    draw(one, one, tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size[0] > 300
