"""A room as a mesh: unit, gravity, place and materials are found, and the room is the one that was modelled."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("trimesh", reason="the extra 'mesh' is not installed")

import trimesh

from mmweaver import Weaver
from mmweaver.core.errors import InputError
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.scanned_mesh.mesh_photo import read_mesh_photo, upright
from mmweaver.scene.scanned_mesh.read_mesh import read_mesh

SIZE_M = (5.0, 6.0, 2.6)
Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
TILT = trimesh.transformations.rotation_matrix(np.deg2rad(4), (1, 0, 0))


def walls() -> Any:
    room = trimesh.creation.box(SIZE_M)
    room.apply_translation((2.5, 3.0, 1.3))
    room.invert()
    return room


def furnished(path: Path, transform: np.ndarray, factor: float = 1.0) -> Path:
    """A room of 5 x 6 x 2.6 m, its corner at the origin, with a sofa at the far wall and a box of another name."""
    sofa, box = trimesh.creation.box((2.0, 0.8, 0.45)), trimesh.creation.box((0.6, 0.6, 1.0))
    sofa.apply_translation((2.5, 5.4, 0.225))
    box.apply_translation((0.6, 5.0, 0.5))
    scene = trimesh.Scene()
    for name, part, grey in (("shell", walls(), 200), ("Sofa.001", sofa, 90), ("Material.003", box, 120)):
        part.visual.vertex_colors = np.tile([grey, grey, grey - 20, 255], (len(part.vertices), 1)).astype(np.uint8)
        part.apply_transform(transform)
        part.apply_scale(factor)
        scene.add_geometry(part, geom_name=name, node_name=name)
    if path.suffix == ".glb":
        scene.export(str(path))
    else:
        scene.to_geometry().export(str(path))
    return path


@pytest.mark.parametrize(
    ("name", "transform", "factor", "said"),
    [
        ("room.glb", Y_UP, 1.0, ""), ("room.ply", np.eye(4), 1000.0, "taken as mm"),
        ("room.ply", Y_UP, 100.0, "taken as cm"), ("room.obj", TILT, 1.0, "taken as m,"),
    ],
)  # fmt: skip
def test_unit_and_gravity_are_found(name: str, transform: np.ndarray, factor: float, said: str, tmp_path: Path):
    path = furnished(tmp_path / name, transform, factor)
    found = upright(path, read_mesh(path))
    low, high = found.mesh.vertices.min(axis=0), found.mesh.vertices.max(axis=0)
    assert high - low == pytest.approx(SIZE_M, abs=0.02)
    assert low[2] == pytest.approx(0, abs=0.02)
    assert said in " ".join(found.assumptions)


def test_a_modelled_room_that_stands_on_a_slab_has_the_floor_that_people_stand_on(tmp_path: Path):
    scene = trimesh.Scene([walls()])
    slab = trimesh.creation.box((5.0, 6.0, 0.15))
    slab.apply_translation((2.5, 3.0, -0.075))
    podium = trimesh.creation.box((2.0, 2.0, 0.3))
    podium.apply_translation((1.0, 1.0, 0.15))
    scene.add_geometry([slab, podium])
    scene.export(str(tmp_path / "room.ply"))
    found = upright(tmp_path / "room.ply", read_mesh(tmp_path / "room.ply"))
    assert found.converted(np.zeros(3))[2] == pytest.approx(0, abs=0.02)


def test_the_room_is_the_one_that_was_modelled(tmp_path: Path):
    """From a place that is given: walls, floor and the seat of the sofa where they were put."""
    path = furnished(tmp_path / "room.glb", Y_UP)
    room = Weaver(method="physics").read_mesh(path, eye=(2.5, 1.1, -0.5), look_deg=90.0)  # glTF: y up, so ahead is -z
    scene = room.scene
    assert scene.floor_z_m == pytest.approx(-1.1, abs=0.03)
    ahead = [plane for plane in scene.planes if plane.kind == "wall" and abs(plane.normal[1]) > 0.95]
    assert ahead[0].centre_m[1] == pytest.approx(5.5, abs=0.05)
    sides = sorted(plane.centre_m[0] for plane in scene.planes if plane.kind == "wall" and abs(plane.normal[0]) > 0.95)
    assert sides == pytest.approx([-2.5, 2.5], abs=0.05)
    assert any(abs(seat.position_m[2] + 1.1 - 0.45) < 0.05 for seat in scene.seats)
    assert scene.free_space.is_free.sum() * 0.0025 > 8  # square metres
    assert len(room.inputs["mesh"]["sha256"]) == 64


def test_names_and_a_table_say_what_things_are(tmp_path: Path):
    path, table = furnished(tmp_path / "room.glb", Y_UP), tmp_path / "materials.json"
    table.write_text(json.dumps({"Material.003": "metal"}))
    classes = read_mesh_photo(path, eye=(2.5, 1.1, -0.5), look_deg=90.0, materials=table).photo.classes
    assert classes is not None
    assert {NAMES[index] for index in np.unique(classes.index)} == {"unlabeled", "couch", "metal"}
    table.write_text(json.dumps({"Material.03": "metal"}))
    said = " ".join(read_mesh_photo(path, eye=(2.5, 1.1, -0.5), look_deg=90.0, materials=table).assumptions)
    assert "no 'Material.03'; it has " in said
    assert "'Material.003'" in said


@pytest.mark.parametrize("content", [b"", b"no mesh", b"ply\nformat ascii 1.0\nend_header\n", b"glTF\2\0\0\0\xff"])
@pytest.mark.parametrize("suffix", [".glb", ".ply", ".obj"])
def test_what_is_no_mesh_is_refused_in_one_line(content: bytes, suffix: str, tmp_path: Path):
    (tmp_path / f"a{suffix}").write_bytes(content)
    with pytest.raises(InputError) as refused:
        read_mesh_photo(tmp_path / f"a{suffix}")
    assert "\n" not in str(refused.value)


def test_what_is_no_room_is_refused(tmp_path: Path):
    trimesh.creation.icosphere(radius=0.1).export(str(tmp_path / "ball.ply"))
    with pytest.raises(InputError, match=r"size|level"):
        read_mesh_photo(tmp_path / "ball.ply")
    path = furnished(tmp_path / "room.glb", Y_UP)
    for wrong, said in (({"unit": "mile"}, "unknown unit"), ({"unit": "mm"}, "right unit"), ({"up": "x"}, "y or z")):
        with pytest.raises(InputError, match=said):
            read_mesh_photo(path, **wrong)
    (tmp_path / "materials.json").write_text('{"shell": "velvetite"}')
    with pytest.raises(InputError, match="velvetite"):
        read_mesh_photo(path, materials=tmp_path / "materials.json")


def test_an_obj_reads_nothing_outside_its_folder(tmp_path: Path):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.mtl").write_text("newmtl stolen\n")
    path = furnished(inside / "room.obj", np.eye(4))
    path.write_text("mtllib ../secret.mtl\n" + path.read_text().replace("mtllib", "# mtllib"))
    assert "stolen" not in read_mesh(path).names
