"""Reads a mesh (GLB, PLY, OBJ) by trimesh: triangles with a colour and a name each."""

import logging
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int, UInt8

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.regular_files import MEGABYTE, check_exists, foreign_errors, read_bytes
from mmweaver.core.safe_files.safe_pictures import safe_decoders
from mmweaver.core.shapes import Array, Faces
from mmweaver.scene.scanned_mesh.glb_header import check_glb

SUFFIXES = (".glb", ".ply", ".obj")
MAX_BYTES = 500 * MEGABYTE
MAX_FACES = 5_000_000
GREY = 180


@dataclass(frozen=True, kw_only=True)
class ColouredMesh:
    """Triangles as stored, in the file's own unit and axes."""

    vertices: Float[Array, "vertex 3"]
    faces: Faces
    rgb: UInt8[Array, "face 3"]
    name: Int[Array, " face"]  # index into `names`
    names: tuple[str, ...]  # of the material, else of the object; "" where the file has none
    has_colours: bool


def read_mesh(path: Path) -> ColouredMesh:
    """Reads a mesh; the .mtl and textures of an .obj are read from its own folder only.

    Args:
        path: GLB, PLY or OBJ.

    Returns:
        Triangles with colour and material or object name.

    Raises:
        InputError: If trimesh is missing or the file holds no triangles.
    """
    need("mesh", f"{path.name} is a mesh, which", "trimesh")
    import trimesh

    suffix = path.suffix.lower()
    check_exists(path, f"a mesh: {', '.join(SUFFIXES)}")
    if suffix not in SUFFIXES:
        raise InputError(f"{path} is no mesh that is read; give one of {', '.join(SUFFIXES)}")
    content = read_bytes(path, max_bytes=MAX_BYTES)
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # problems raise InputError or are ignored
    with foreign_errors(path, "no mesh ({reason}); save it as GLB, PLY or OBJ with triangles"), safe_decoders():
        if suffix == ".glb":
            check_glb(content)
        loaded: Any = trimesh.load_scene(
            BytesIO(content),
            file_type=suffix[1:],
            resolver=_files_in_folder_of(path) if suffix == ".obj" else None,
            process=False,
        )
        parts = [part for part in loaded.dump() if isinstance(part, trimesh.Trimesh) and len(part.faces)]
        if sum(len(part.faces) for part in parts) > MAX_FACES:
            raise InputError(f"{path} has more than {MAX_FACES:,} triangles; simplify the mesh")
        read = [_part(part) for part in parts]
        if any(vertices.shape[1:] != (3,) or faces.shape[1:] != (3,) for vertices, faces, *_ in read):
            raise ValueError("its corners are no places, or its faces no triangles")
    if not read:
        raise InputError(f"{path} holds no triangles; a cloud of points is no mesh")
    return _joined(path, read)


def _files_in_folder_of(path: Path) -> Any:
    """A resolver that reads plain file names in the folder of a file only."""
    from trimesh.resolvers import Resolver

    class OwnFolder(Resolver):
        def __init__(self) -> None:
            """Keeps nothing."""

        def get(self, key: str) -> bytes:
            return read_bytes(path.parent / Path(key.strip().replace("\\", "/")).name, max_bytes=MAX_BYTES)

        def keys(self) -> list[str]:
            return []

        def write(self, name: str, data: object) -> None:
            raise OSError("a mesh is read only")

        def namespaced(self, namespace: str) -> Resolver:
            return self

    return OwnFolder()


def _part(part: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray | None, str]:
    """Vertices, faces, colours (face, 3) and name of one geometry."""
    visual = part.visual
    material = getattr(visual, "material", None)
    name = getattr(material, "name", None) or part.metadata.get("name") or ""
    colours = None
    if getattr(visual, "defined", False):
        try:
            coloured = visual.to_color() if visual.kind == "texture" else visual
            of_vertices = np.asarray(coloured.vertex_colors)
        except Exception:  # a texture that is not read
            of_vertices = np.empty(0)
        if of_vertices.shape == (len(part.vertices), 4):
            colours = of_vertices[np.asarray(part.faces), :3].mean(axis=1)
    return np.asarray(part.vertices, float), np.asarray(part.faces, np.int64), colours, str(name)[:80]


def _joined(path: Path, parts: list[tuple[np.ndarray, np.ndarray, np.ndarray | None, str]]) -> ColouredMesh:
    names = tuple(dict.fromkeys(name for *_, name in parts))
    starts = np.cumsum([0, *(len(vertices) for vertices, *_ in parts)])
    vertices = np.concatenate([vertices for vertices, *_ in parts])
    faces = np.concatenate([faces + start for (_, faces, *_), start in zip(parts, starts, strict=False)])
    if not np.isfinite(vertices).all() or faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(f"{path} has corners that are no numbers or that its faces do not have; save it again")
    rgb = np.concatenate([np.full((len(faces), 3), GREY) if rgb is None else rgb for _, faces, rgb, _ in parts])
    return ColouredMesh(
        vertices=vertices,
        faces=faces,
        rgb=rgb.round().astype(np.uint8),
        name=np.concatenate([np.full(len(faces), names.index(name)) for _, faces, _, name in parts]),
        names=names,
        has_colours=any(rgb is not None for *_, rgb, _ in parts),
    )
