"""The readers of meshes, which trimesh decodes: GLB, PLY as text and in binary, OBJ with its materials' names."""

import random
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from mmweaver.scene.scanned_mesh.mesh_photo import read_mesh_photo
from tests.fuzz import mutators as m
from tests.fuzz.harness import Reader, wrong_numbers
from tests.scene.scanned_mesh.test_mesh_photo import Y_UP, furnished


def mesh_readers(folder: Path) -> list[Reader]:
    """All of them, with sound files made in `folder`."""
    ply: Any = trimesh.load_mesh(furnished(folder / "room.ply", np.eye(4)), process=False)
    return [
        _reader(".glb", [furnished(folder / "room.glb", Y_UP).read_bytes()]),
        _reader(".ply", [ply.export(file_type="ply", encoding=kind) for kind in ("ascii", "binary")]),
        _reader(".obj", [b"mtllib room.mtl\nusemtl wall\n" + furnished(folder / "room.obj", np.eye(4)).read_bytes()]),
    ]


def _reader(suffix: str, sound: list[bytes]) -> Reader:
    def damaged(rng: random.Random) -> bytes:
        data = rng.choice(sound)
        if data.isascii() and rng.random() < 0.7:
            return m.mutated_text(data.decode(), rng).encode("utf-8", "surrogatepass")
        return m.mutated_bytes(data, rng)

    def wrong(found: Any) -> str | None:
        depth_m = found.photo.depth_m
        return wrong_numbers(depth_m[~np.isnan(depth_m)])

    return Reader(f"mesh {suffix}", suffix, damaged, read_mesh_photo, wrong)
