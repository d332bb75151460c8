"""Rooms and results show sizes rather than arrays, and become figures, datasets and tensors."""

import re

import numpy as np
import pytest
import torch

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Generation, Room


@pytest.fixture(scope="module")
def room() -> Room:
    return Weaver("physics").sample_room()


@pytest.fixture(scope="module")
def result(room: Room) -> Generation:
    return Weaver("physics").generate(room, ["a person stands", "a person waves"], frames=4, seed=2, keep_adc=True)


def test_one_line_each(room: Room, result: Generation):
    assert result.adc is not None
    shown = [room, room.scene, room.scene.photo, result, result.cube, result.adc, result.points, result.pose]
    for record in shown:
        text = repr(record)
        assert text.startswith(f"{type(record).__name__}(")
        assert len(text) < 400
        assert "array" not in text
        assert "\n" not in text
    assert "640 x 480 pixels" in repr(room)
    assert "range: 64, 0.70 to 3.48 m" in repr(result.cube)
    assert "a person stands | a person waves" in repr(result)
    assert f"points: {len(result.points.frame)}" in repr(result.points)
    assert "height: " in repr(result.pose)


def test_notebooks_show_a_table_and_a_picture(room: Room, result: Generation):
    for record in (result.cube, result.points, result.pose):
        assert record._repr_html_().count("<tr>") == len(record.facts())
    for record in (room, result):
        assert re.search("<img src='data:image/png;base64,[A-Za-z0-9+/]{1000,}", record._repr_html_())
    odd = Generation(**{**vars(result), "meta": {**result.meta, "text": "<b>"}})
    assert "&lt;b&gt;" in odd._repr_html_()


def test_the_figure_is_the_page(result: Generation):
    figure = result.plot()
    assert figure.get_size_inches().tolist() == [16.0, 9.0]
    assert len(figure.axes) == 9


def test_tensors(result: Generation):
    found = result.to_torch()
    assert found["cube"].dtype == torch.complex64
    assert found["cube"].shape == (4, 64, 32, 12)
    assert torch.equal(found["cube"], torch.from_numpy(result.cube.values))
    assert found["joints_m"].shape == (2, 4, 22, 3)
    assert found["points"].shape == (len(result.points.frame), 6)
    assert found["adc"].shape == (4, 32, 3, 4, 256)


def test_a_dataset_with_coordinates_of_the_same_name(result: Generation):
    pytest.importorskip("xarray")
    found = result.to_xarray()
    near = found.cube.sel(range=1.0, method="nearest").sel(radial_velocity=0.0, method="nearest")
    assert near.dims == ("frame_time", "antenna")
    assert np.array_equal(near.values, result.cube.values[:, 7, 16])
    assert found.range.attrs["units"] == "m"
    assert found.joints.sel(person=1, joint="left_wrist").shape == (4, 3)
    assert found.joint.values.tolist() == list(JOINT_NAMES)
    assert found.sizes["point"] == len(result.points.frame)
    assert found.adc.dims == ("frame_time", "loop", "transmitter", "receiver", "sample")
    assert found.attrs["seed"] == 2
